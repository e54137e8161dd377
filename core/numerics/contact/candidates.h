#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/broad_phase.h"
#include "core/numerics/collision_detection/dihedrals.h"
#include "core/numerics/collision_detection/surface.h"
#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/contact/surface_contacts.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

/// The largest numbers of pairs that a search goes on with: of overlapping boxes, and of primitives that may
/// come within d̂.
struct PairLimits {
  long boxes, primitives;
  bool operator==(const PairLimits&) const = default;
};

/// Whether a pair can come within d̂: a bound from its distance and the relative motion of its primitives.
bool may_come_within_dhat(const ContactPair& pair, const LinearMotion& motion);

/// The vertices of vertex v and triangle t of two surfaces, whose vertices 0 have these indices in pairs.
inline std::array<int, 4> vertex_triangle(int first, int v, const SurfaceTopology& other, int first_other,
                                          int t) {
  const auto w = other.triangles.row(t);
  return {first + v, first_other + w[0], first_other + w[1], first_other + w[2]};
}

/// The vertices of edges e and f of two surfaces, whose vertices 0 have these indices in pairs.
inline std::array<int, 4> edge_edge(const SurfaceTopology& own, int e, const SurfaceTopology& other,
                                    int first_other, int f) {
  const auto v = own.edges.row(e), w = other.edges.row(f);
  return {v[0], v[1], first_other + w[0], first_other + w[1]};
}

/// A primitive of the cloth and one of the obstacles: a vertex and a triangle, a triangle and a vertex, or
/// two edges. Most are too far apart for contact, so this has no weights yet.
struct ObstaclePair {
  static constexpr double offset = 0;  ///< triangles are not rounded
  std::array<int, 4> vertices;         ///< as of ContactPair
  PairKind kind;
  int own, other;  ///< the primitives' indices in the two surfaces
};

/// Sets `found` to the pairs of primitives that may come within d̂ during the motion, from rows of triangles
/// whose swept boxes overlap. The order depends on the rows alone. Returns false once there are more than
/// `limit` pairs.
bool find_obstacle_pairs(const SweptBoxes& cloth, const SweptBoxes& obstacles, const AdjacencyList& rows,
                         const LinearMotion& motion, long limit, std::vector<ObstaclePair>& found);

/// The pairs that find_obstacle_pairs finds, if `pairs` has them all, in the order of `pairs`.
std::vector<ObstaclePair> obstacle_pairs_among(const std::vector<ObstaclePair>& pairs,
                                               const SweptBoxes& cloth, const SweptBoxes& obstacles,
                                               const LinearMotion& motion);

/// Appends pairs of find_obstacle_pairs, with their weights; `friction` is μ where an obstacle has none of
/// its own.
///
/// Cloth vertices against obstacle triangles have weight 0 as pairs: their barrier is that of the nearest
/// features (surface_candidates). The weight of the others is reduced where the obstacle protrudes between
/// its vertices by less than d̂ / 8, to 0 where it is flat: there the cloth's vertices make contact first.
void append_contact_pairs(const std::vector<ObstaclePair>& pairs, const Surface& cloth,
                          const ObstacleSurface& obstacles, const Dihedrals& dihedrals, double dhat,
                          double friction, std::vector<ContactPair>& all);

/// The cloth vertices and obstacle triangles among pairs of find_obstacle_pairs, contiguous for each vertex
/// and ascending by triangle.
std::vector<VertexTriangleCandidate> surface_candidates(const std::vector<ContactPair>& pairs,
                                                        const Surface& cloth);

/// Searches for vertex-triangle and edge-edge pairs of the cloth that share no vertex. Keeps the trees of its
/// primitives between searches; results do not depend on earlier ones.
class SelfPairSearch {
 public:
  /// `cloth` must outlive the search.
  SelfPairSearch(const Surface& cloth, BroadPhaseKind kind);

  /// Appends the pairs that may come within d̂ during the motion, in the order of their representative
  /// triangles, and adds the number of overlapping boxes to `boxes`. Returns false, without pairs, once there
  /// are more than `limits`.
  bool find(const LinearMotion& motion, double friction, const PairLimits& limits, long& boxes,
            std::vector<ContactPair>& found);

 private:
  const Surface& cloth_;
  SweptBoxes boxes_;
  std::vector<Box> edge_boxes_;
  std::unique_ptr<BroadPhase> vertices_, edges_, triangles_;
  AdjacencyList rows_;
};

}  // namespace drape
