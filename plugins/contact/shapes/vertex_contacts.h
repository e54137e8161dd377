#pragma once

#include <memory>
#include <vector>

#include "core/contact/pair_contacts.h"
#include "plugins/contact/shapes/solid.h"

namespace drape {

/// A vertex of the cloth that may come near a solid.
struct VertexPair {
  int vertex;
  int solid;
  double weight;  ///< area that it stands for [m²]
};

/// The energy κ d̂ Σ weight b(gap / d̂) over those of `pairs` within range at x, by the solids' own distance:
/// its Hessian has the axes normal, tangent and normal × tangent, so that it needs no decomposition.
std::unique_ptr<ContactSet> make_vertex_contacts(const Positions& x, const std::vector<Solid>& solids,
                                                 const std::vector<VertexPair>& pairs,
                                                 const BarrierParameters& parameters);

}  // namespace drape
