#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/collision_detection/closest.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

/// Point 0 against triangle 1 … 3, or edge (0, 1) against edge (2, 3). edge_end is point 0, the end of edge
/// (0, 1), against edge (2, 3).
enum class PairKind : char { point_triangle, edge_edge, edge_end };

/// A pair of primitives. Indices count the cloth's n vertices, then the obstacles'.
struct ContactPair {
  std::array<int, 4> vertices;
  PairKind kind = PairKind::point_triangle;
  int obstacle = -1;          ///< index in the contact model; -1 for two primitives of the cloth
  double weight = 0;          ///< area weight of the pair's energy [m²]
  double dhat = 0;            ///< d̂ of the pair, below which its barrier acts [m]
  double offset = 0;          ///< a rounded obstacle's radius: gap = distance - offset [m]
  double mollifier = 0;       ///< edge_edge, edge_end: ε of the mollifier, |u × v|² [m⁴]
  double friction = 0;        ///< μ
  bool at_rim = false;        ///< a cloth edge at a sharp edge of an obstacle (make_rim_contacts)
  int surface_triangle = -1;  ///< of a cloth vertex and an obstacle triangle: this triangle; else -1
};

/// The linear motion of the cloth from x0 to x1 and of the obstacles' vertices, searched for pairs within d̂.
struct LinearMotion {
  const Positions& x0;
  const Positions& x1;
  double dhat;  ///< d̂ [m]
  const Positions &obstacles0, &obstacles1;
};

/// The barrier potential κ Σ_pairs d̂ · weight · m · b(gap / d̂), b(s) = -(s - 1)² ln s, m the edge-edge
/// mollifier, over those `pairs` whose gap at x (cloth, n×3) is below their d̂, in their order. Obstacle
/// vertices are static. +∞ if a gap is not positive.
std::unique_ptr<Collisions> make_pair_contacts(const Positions& x, const Positions& obstacle_vertices,
                                               const std::vector<ContactPair>& pairs,
                                               const BarrierParameters& parameters);

/// The barrier between edges of the cloth and edges of obstacles, of which either is the first,
///
///     κ d̂ Σ_pairs weight · m · (b - b_0)(b - b_1) / b,
///
/// with b of the distance of the two edges, b_k of that from end k of the first edge to the second, and
/// m the edge-edge mollifier. Obstacle vertices are static. +∞ if a gap is not positive.
///
/// First edges of the cloth meet sharp edges: the barrier of the cloth's vertices acts on the ends already.
/// Where an end is nearest, and over the whole of a surface up to its rim, the sum is therefore 0; while an
/// end passes beyond the rim, it grows by what that of the vertex loses. With b alone a cloth would have to
/// climb its rim's barrier before it can slide over it. A first edge of an obstacle is the axis of a
/// cylinder, whose side ends where its axis does.
std::unique_ptr<Collisions> make_rim_contacts(const Positions& x, const Positions& obstacle_vertices,
                                              const std::vector<ContactPair>& pairs,
                                              const BarrierParameters& parameters);

/// The part of a motion that is safe, and the index of the pair that limits it; -1 for a fraction of 1.
struct SafeFraction {
  double fraction = 1;
  int blocking = -1;
  bool operator==(const SafeFraction&) const = default;
};

/// A fraction of the motion x0 → x1 that keeps at least `min_gap_fraction` of every pair's gap at x0, by
/// additive CCD (Li et al. 2021). Safe under rounding. Departure from the paper: each iteration also advances
/// by the time for which the current separating plane stays separating. Obstacle vertices are static. The
/// fraction is 0 if a moving pair's gap at x0 is not above round-off.
///
/// The limiting pair keeps no more than min_gap_fraction + 0.02 of its gap, except for 1 pair in 1000, which
/// reaches the limit of 256 iterations. With min_gap_fraction = 0.1 and a constant closing speed the fraction
/// is at least 0.88 of the exact time of impact. Of adversarial motions (tests/unit/contact/additive_ccd.cpp)
/// half reach 0.90 of it and 99 in 100 reach 0.6; in the others the pair comes close and then slides.
SafeFraction additive_ccd(const Positions& x0, const Positions& x1, const Positions& obstacle_vertices,
                          const std::vector<ContactPair>& pairs, double min_gap_fraction);

}  // namespace drape
