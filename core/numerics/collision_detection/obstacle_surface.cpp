#include "core/numerics/collision_detection/obstacle_surface.h"

#include <utility>

namespace drape {

ObstacleTopology::ObstacleTopology(SurfaceTopology all) : SurfaceTopology(std::move(all)) {
  const int edge_count = static_cast<int>(edges.rows());
  vertex_triangles = AdjacencyList::of(vertex_count(), [&](const auto& add) {
    for (int t = 0; t < triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) add(triangles(t, k), t);
  });
  vertex_edges = AdjacencyList::of(vertex_count(), [&](const auto& add) {
    for (int e = 0; e < edge_count; ++e)
      for (int k = 0; k < 2; ++k) add(edges(e, k), e);
  });
  edge_corners = AdjacencyList::of(edge_count, [&](const auto& add) {
    for (int t = 0; t < triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) add(triangle_edges(t, k), 3 * t + k);
  });
}

}  // namespace drape
