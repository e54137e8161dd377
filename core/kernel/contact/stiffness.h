#pragma once

#include <algorithm>

#include "core/kernel/model/material.h"

namespace drape {

/// The default barrier stiffness κ [Pa]: ten times the material's weight per area, ρ d g.
///
/// A cloth at rest on an obstacle satisfies κ |b'(s)| = ρ d g, hence |b'(s)| = 1/10 and a gap of 0.83 d̂. Ten
/// times its weight leaves 0.53 d̂, a thousand times 0.01 d̂. Area weights make gaps independent of the mesh
/// where the load is spread over an area. At sharp edges and corners of obstacles it is not: with edges of
/// length h a vertex carries a load that falls as h at an edge and stays at a corner, while its weight falls
/// as h². Gaps there shrink as the mesh is refined. ρ d is clamped to [1 mg/m², 1000 t/m²], beyond any cloth,
/// for scenes from a millimetre to a hundred metres: κ is within [9.81e-5, 9.81e7] Pa, and a weightless
/// material still has a barrier. Source: this project.
inline double contact_stiffness(const Material& material) {
  return 10 * standard_gravity * std::clamp(material.area_density(), 1e-6, 1e6);
}

}  // namespace drape
