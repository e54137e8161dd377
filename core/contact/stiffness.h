#pragma once

#include <algorithm>

#include "core/model/material.h"

namespace drape {

/// The barrier stiffness κ [Pa] that suits a material: ten times its weight a unit of area, ρ d g.
///
/// A cloth at rest on something has κ |b'(s)| = ρ d g, hence |b'(s)| = 1/10 and a gap of 0.83 d̂; ten times
/// its weight, as where it hangs from an edge, leaves 0.53 d̂, a thousand times 0.01 d̂. So gaps stay clear
/// of rounding, and the barrier is no stiffer than they need. Pairs are weighted by area, so nothing of this
/// depends on the mesh. ρ d is clamped to [1 mg/m², 1000 t/m²], which no cloth leaves, be it a scene of a
/// millimetre or of a hundred metres: κ is within [9.81e-5, 9.81e7] Pa, and a weightless material still has a
/// barrier. Source: this project.
inline double contact_stiffness(const Material& material) {
  const double gravity = 9.81;  // [m/s²]
  return 10 * gravity * std::clamp(material.area_density(), 1e-6, 1e6);
}

}  // namespace drape
