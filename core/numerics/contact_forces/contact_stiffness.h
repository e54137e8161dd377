#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/interfaces/material.h"

namespace drape {

// The barrier stiffness κ where the experiment gives none. It begins with the weight and the loads of the
// cloth and follows what contacts carry, by factors of four, so that small differences between two solves
// leave them the same κ. Source: this project.

/// κ for the cloth's own weight [Pa]: ten times the material's weight per area, ρ d g.
///
/// A cloth at rest on an obstacle satisfies κ |b'(s)| = ρ d g, hence |b'(s)| = 1/10 and a gap of 0.83 d̂. Ten
/// times its weight leaves 0.53 d̂, a hundred times 0.12 d̂, a thousand times 0.01 d̂. Area weights make gaps
/// independent of the mesh where the load is spread over an area. At sharp edges and corners of obstacles it
/// is not: with edges of length h a vertex carries a load that falls as h at an edge and stays at a corner,
/// while its weight falls as h². Gaps there shrink as the mesh is refined. ρ d is clamped to
/// [1 mg/m², 1000 t/m²], beyond any cloth, for scenes from a millimetre to a hundred metres: κ is within
/// [9.81e-5, 9.81e7] Pa, and a weightless material still has a barrier.
inline double contact_stiffness(const Material& material) {
  return 10 * standard_gravity * std::clamp(material.area_density(), 1e-6, 1e6);
}

/// κ for loads of this pressure on the cloth [Pa], such as an inflation: the largest κ 4^k that is at most
/// ten times the pressure, and at least κ.
inline double stiffness_for_load(double stiffness, double pressure) {
  // The load may be infinite on the rest shape, where the cloth need not start.
  if (!std::isfinite(10 * pressure)) return stiffness;
  while (stiffness > 0 && 4 * stiffness <= 10 * pressure) stiffness *= 4;
  return stiffness;
}

/// κ for contacts whose mean pressure over κ is known [1], where the forces on the cloth nearly balance: four
/// times as large above a pressure of 50 κ, at which gaps are about d̂ / 50, but at most `largest` [Pa].
///
/// Tension, edges of obstacles and layers above press far more than weight. With gaps that small a step gains
/// little before collision detection ends it. Ordinary drapes have a mean below 10.
inline double raised_stiffness(double stiffness, double mean_pressure, double largest) {
  constexpr double largest_mean = 50;
  return mean_pressure > largest_mean ? std::max(stiffness, std::min(4 * stiffness, largest)) : stiffness;
}

/// The κ of each of the contacts [Pa].
inline ContactStiffness stiffness_of(const BoundContacts& contacts) {
  ContactStiffness stiffness;
  for (const auto& contact : contacts) stiffness.push_back(contact->stiffness());
  return stiffness;
}

/// The contacts with the larger of their own κ and `stiffness`, which may be empty or has a value for each;
/// the same objects where κ stays.
inline BoundContacts stiffened(BoundContacts contacts, const ContactStiffness& stiffness) {
  for (std::size_t k = 0; k < stiffness.size(); ++k)
    if (stiffness[k] > contacts.at(k)->stiffness())
      if (auto stiffer = contacts[k]->with_stiffness(stiffness[k])) contacts[k] = std::move(stiffer);
  return contacts;
}

}  // namespace drape
