#pragma once

#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/linear_motion.h"
#include "core/numerics/collision_detection/obstacle_surface.h"
#include "core/numerics/collision_detection/surface.h"
#include "core/numerics/contact/nearest_features.h"
#include "core/numerics/contact/pair_contacts.h"

namespace drape {

/// Candidate pairs before classification. `vertex_triangles` repeats those of a cloth vertex and an obstacle
/// triangle: contiguous for each vertex and ascending by triangle.
struct BroadPhasePairs {
  std::vector<ContactPair> pairs;
  std::vector<VertexTriangleCandidate> vertex_triangles;

  long count() const { return static_cast<long>(pairs.size()); }
  void clear() {
    pairs.clear();
    vertex_triangles.clear();
  }
};

/// Numbers of pairs: of overlapping boxes, and of primitives that may come within d̂.
struct PairCounts {
  long boxes = 0, primitives = 0;
  bool operator==(const PairCounts&) const = default;
};

/// Appends to `found` the pairs of primitives that may come within d̂ during the motion, from rows of
/// triangles whose swept boxes overlap. The order depends on the rows alone. Returns false once `found` has
/// more than `limit` pairs.
///
/// Cloth vertices against obstacle triangles, obstacle vertices against cloth triangles, edges against edges.
/// The first have weight 0 as pairs: their barrier is that of the nearest features. The weight of the others
/// is reduced where the obstacle protrudes between its vertices by less than d̂ / 8, to 0 where it is flat:
/// there the cloth's vertices make contact first.
bool find_obstacle_pairs(const Surface& cloth, const SweptBoxes& boxes, const ObstacleSurface& obstacles,
                         const SweptBoxes& obstacle_boxes, const AdjacencyList& rows,
                         const LinearMotion& motion, double friction, long limit, BroadPhasePairs& found);

}  // namespace drape
