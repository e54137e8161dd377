#pragma once

#include <memory>
#include <vector>

#include "core/numerics/contact/pair_contacts.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

/// The barrier between edges of the cloth and sharp edges of obstacles,
///
///     κ d̂ Σ_pairs weight · m · (b - b_0)(b - b_1) / b,
///
/// with b of the distance of the two edges, b_k of that from end k of the cloth's edge to the obstacle's, and
/// m the edge-edge mollifier. Obstacle vertices are static. +∞ if a gap is not positive.
///
/// The barrier of the cloth's vertices acts on the ends already. Where an end is nearest, and over the whole
/// of a surface up to its rim, the sum is therefore 0; while an end passes beyond the rim, it grows by what
/// that of the vertex loses. With b alone a cloth would have to climb its rim's barrier before it can slide
/// over it.
std::unique_ptr<Collisions> make_rim_contacts(const Positions& x, const Positions& obstacle_vertices,
                                              const std::vector<ContactPair>& pairs,
                                              const BarrierParameters& parameters);

}  // namespace drape
