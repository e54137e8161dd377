#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "core/numerics/collision_detection/surface.h"

namespace drape {

/// Triangles and edges of obstacles with their neighbours, which all poses of them share.
struct ObstacleTopology : SurfaceTopology {
  AdjacencyList vertex_triangles, vertex_edges;  ///< of each vertex, ascending
  AdjacencyList edge_corners;  ///< 3 t + k of each vertex k of a triangle t opposite the edge, ascending

  explicit ObstacleTopology(SurfaceTopology all);
};

/// A pose of the triangle meshes that a cloth collides with, as one surface of several bodies.
struct ObstacleSurface {
  Positions vertices;  ///< of all bodies [m]
  std::shared_ptr<const ObstacleTopology> topology;
  std::vector<int> first_vertex;                       ///< of each body, then the total number
  std::vector<std::optional<double>> body_friction{};  ///< μ of each body that has its own

  int body_of(int vertex) const {
    const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
    return static_cast<int>(next - first_vertex.begin()) - 1;
  }
  /// μ of a body: its own, or the contact model's.
  double friction_of(int body, double of_model) const { return body_friction[body].value_or(of_model); }
};

}  // namespace drape
