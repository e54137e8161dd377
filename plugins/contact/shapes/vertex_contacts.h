#pragma once

#include <memory>
#include <vector>

#include "core/kernel/contact/pair_contacts.h"
#include "plugins/contact/shapes/solid.h"

namespace drape::shapes {

/// A cloth vertex and a solid that may come within d̂.
struct VertexSolidPair {
  int vertex;
  int solid;
  double weight;  ///< the vertex's rest area [m²]
};

/// The barrier potential κ d̂ Σ weight b(gap / d̂) over those `pairs` within d̂ at x, with the solids'
/// closed-form distance. The eigenvectors of its Hessian are known: normal, tangent and normal × tangent.
std::unique_ptr<Collisions> make_vertex_contacts(const Positions& x, const std::vector<Solid>& solids,
                                                 const std::vector<VertexSolidPair>& pairs,
                                                 const BarrierParameters& parameters);

}  // namespace drape::shapes
