#pragma once

#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/box.h"

namespace drape {

/// A triangle surface for contact: rest areas and lengths, and the representative triangle of each vertex and
/// edge (Curtis et al. 2008), through which pairs of triangles yield every pair of primitives once.
struct Surface {
  Triangles triangles;
  Triangles triangle_edges;  ///< column k: the edge opposite vertex k
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges;
  /// 3 t + k of the representative triangle t: vertex k, or the edge opposite it.
  std::vector<int> vertex_corner, edge_corner;
  Eigen::VectorXd vertex_area, edge_area;  ///< a third of the adjacent rest areas [m²]
  Eigen::VectorXd triangle_area;           ///< at rest [m²]
  Eigen::VectorXd edge_length_squared;     ///< at rest [m²]

  /// The surface of a mesh without triangles of no area and vertices of no triangle; `topology` is its own.
  static Surface of(const TriangleMesh& rest, const Topology& topology);
  /// Appends another surface. Its vertices, edges and triangles follow this one's.
  void append(const Surface& other);

  int triangle_count() const { return static_cast<int>(triangles.rows()); }
  bool represents_vertex(int t, int k) const { return vertex_corner[triangles(t, k)] == 3 * t + k; }
  bool represents_edge(int t, int k) const { return edge_corner[triangle_edges(t, k)] == 3 * t + k; }
};

/// Bounding boxes of a surface's linear motion.
struct SweptBoxes {
  const Surface& surface;
  std::vector<Box> vertices, edges, triangles;

  /// `moving` must outlive the boxes.
  explicit SweptBoxes(const Surface& moving) : surface(moving) {}
  /// Bounds the motion from x0 to x1 (n×3) [m], inflated by `margin` [m], relative to `origin` [m]: a box has
  /// floats, which are fine near it alone.
  void update(const Positions& x0, const Positions& x1, double margin, const Eigen::RowVector3d& origin);
};

}  // namespace drape
