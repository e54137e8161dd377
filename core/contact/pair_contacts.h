#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/contact/closest.h"
#include "core/model/contact_model.h"

namespace drape {

/// Vertex 0 against 1 … 3, or edge (0, 1) against edge (2, 3). A plane is the whole plane of an obstacle's
/// three vertices: it does not move.
enum class PairKind : char { point_triangle, edge_edge, point_plane };

/// One pair of primitives, by indices into the cloth's vertices 0 … n - 1 followed by the obstacles'.
struct ContactPair {
  std::array<int, 4> vertices;
  PairKind kind = PairKind::point_triangle;
  double weight = 0;     ///< area that the pair stands for [m²]
  double offset = 0;     ///< the gap is the distance less this: a rounded obstacle's radius [m]
  double mollifier = 0;  ///< edge_edge: |u × v|² below which parallel edges are faded out [m⁴]
  double friction = 0;   ///< μ
};

/// The barrier that all pairs share (docs/method.md, section 6).
struct BarrierParameters {
  double range = 1e-3;          ///< d̂ [m]
  double stiffness = 1;         ///< κ [Pa]
  double slip_distance = 1e-4;  ///< ε_v h: a contact that moved less than this sticks [m]
};

/// The energy κ d̂ Σ_pairs weight · m · b(gap / d̂) with b(s) = -(s - 1)² ln s, m the edge-edge mollifier.
/// Keeps those of `pairs` whose gap at x (cloth, n×3) is below the range, in their order. Obstacle vertices
/// stay where they are. +∞ where a gap is not positive.
std::unique_ptr<ContactSet> make_pair_contacts(const Positions& x, const Positions& obstacle_vertices,
                                               const std::vector<ContactPair>& pairs,
                                               const BarrierParameters& parameters);

/// A fraction of the motion x0 → x1 up to which every pair's gap stays at least `keep` times what it is at
/// x0, and never an impact, whatever the rounding (additive conservative advancement, Li et al. 2021, which
/// also advances by the time that a plane between the sides stays between them; at most 256 rounds).
/// `blocking` gets the pair that ends it, -1 at fraction 1. Obstacle vertices do not move. 0 when a moving
/// pair's gap is not above rounding at x0.
///
/// The pair that ends it has kept no more than keep + 0.02 of its gap, but for 1 in 1000 that run out of
/// rounds. So with keep = 0.1 and a constant closing speed the fraction is at least 0.88 of the exact time of
/// impact. Of adversarial motions (tests/unit/additive_ccd.cpp) half reach 0.90 of it and 99 in 100 reach
/// 0.6; the rest come near and then slide.
double additive_ccd(const Positions& x0, const Positions& x1, const Positions& obstacle_vertices,
                    const std::vector<ContactPair>& pairs, double keep, int& blocking);

}  // namespace drape
