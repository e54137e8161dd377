#pragma once

#include <vector>

#include "core/contact/pair_contacts.h"
#include "core/mesh/topology.h"
#include "plugins/contact/ipc/nearest_features.h"
#include "plugins/contact/ipc/obstacle.h"
#include "plugins/contact/ipc/surface.h"

namespace drape {

/// The cloth's straight way from x0 to x1, that of the obstacles' vertices, and how near counts.
struct Way {
  const Positions& x0;
  const Positions& x1;
  double range;  ///< d̂ [m]
  const Positions &obstacles0, &obstacles1;
};

/// Pairs of primitives, and cloth vertices with obstacle triangles once more: for each vertex ascending by
/// triangle, and in a row.
struct FoundPairs {
  std::vector<ContactPair> pairs;
  std::vector<NearTriangle> near;

  long count() const { return static_cast<long>(pairs.size()); }
  void clear() {
    pairs.clear();
    near.clear();
  }
};

/// Share of |e|²|e'|² (at rest) below which nearly parallel edges are faded out: IPC (Li et al. 2020),
/// section 5.
inline constexpr double mollifier_share = 1e-3;

// Both list the pairs of primitives that may come within the range on the way, from rows of triangles whose
// swept boxes overlap, in an order that depends on the rows alone. They append to `found`, and give up and
// return false once its pairs are more than `limit`.

/// Vertices against triangles and edges against edges of the cloth; none that share a vertex.
bool find_self_pairs(const Surface& cloth, const SweptBoxes& boxes, const AdjacencyList& rows, const Way& way,
                     double friction, long limit, FoundPairs& found);

/// Cloth vertices against obstacle triangles, obstacle vertices against cloth triangles, edges against edges.
/// The first have no weight as pairs: their barrier is that of the nearest features. The others have less
/// where the obstacle stands out of the cloth between its vertices by less than an eighth of the range, and
/// none where it is flat: there the cloth's vertices come first.
bool find_obstacle_pairs(const Surface& cloth, const SweptBoxes& boxes, const Obstacles& obstacles,
                         const SweptBoxes& obstacle_boxes, const AdjacencyList& rows, const Way& way,
                         double friction, long limit, FoundPairs& found);

}  // namespace drape
