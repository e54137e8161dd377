#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// A cloth's flat pieces in the plane. A vertex has an image in each piece that it belongs to, and two in one
/// piece where that is sewn to itself, as along a sleeve.
struct FlatCloth {
  struct Image {
    int vertex, piece;
    Eigen::Vector2d place;  ///< in the plane of its piece, which is drawn with its front up [m]
    Eigen::Vector2d uv;     ///< its texture coordinates; 0 without any
  };
  /// One side of an outline edge, along the direction of its triangle.
  struct Side {
    int edge, from, to;  ///< the mesh's edge, and images
  };

  std::vector<Image> images;
  Triangles triangles;     ///< m×3 images, counter-clockwise
  std::vector<int> piece;  ///< of each triangle
  int piece_count = 0;
  std::vector<Side> outline;      ///< borders, and both sides of seams
  AdjacencyList of_vertex;        ///< images of each vertex
  std::vector<char> on_outline;   ///< n flags
  Eigen::VectorXd triangle_area;  ///< n, mean area at rest of the triangles around each vertex [m²]

  /// Lays out a cloth of flat pieces, or a mesh whose connected parts are flat; nothing for another mesh.
  /// Throws std::runtime_error naming a triangle that is turned over.
  static std::optional<FlatCloth> of(const Level& level);
};

}  // namespace drape
