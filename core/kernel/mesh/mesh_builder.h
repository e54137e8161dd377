#pragma once

#include <vector>

#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// A mesh that grows while a file is read.
struct MeshBuilder {
  std::vector<double> coordinates;  ///< 3n
  std::vector<int> corners;         ///< 3m

  int vertex_count() const { return static_cast<int>(coordinates.size() / 3); }

  /// Cuts a polygon of at least three vertices into a fan around its first.
  void add_polygon(const std::vector<int>& polygon) {
    for (std::size_t k = 2; k < polygon.size(); ++k)
      corners.insert(corners.end(), {polygon[0], polygon[k - 1], polygon[k]});
  }

  TriangleMesh mesh() const {
    return {
        Eigen::Map<const Positions>(coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3),
        Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3)};
  }
};

}  // namespace drape
