#pragma once

#include <vector>

#include "core/kernel/contact/box.h"
#include "core/kernel/mesh/topology.h"

namespace drape {

/// A triangle surface for contact: rest areas and lengths, and the representative triangle of each vertex and
/// edge (Curtis et al. 2008), through which pairs of triangles yield every pair of primitives once.
struct Surface {
  Triangles triangles;
  Triangles triangle_edges;  ///< column k: the edge opposite vertex k
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges;
  std::vector<char> representative;  ///< bits per triangle: k for vertex k, 3 + k for the edge opposite it
  Eigen::VectorXd vertex_area, edge_area;  ///< a third of the adjacent rest areas [m²]
  Eigen::VectorXd triangle_area;           ///< at rest [m²]
  Eigen::VectorXd edge_length_squared;     ///< at rest [m²]

  /// Of a mesh whose triangles have areas and whose vertices have triangles, and its topology.
  static Surface of(const TriangleMesh& rest, const Topology& topology);
  /// Appends another surface. Its vertices, edges and triangles follow this one's.
  void append(const Surface& other);

  int triangle_count() const { return static_cast<int>(triangles.rows()); }
  bool represents_vertex(int t, int k) const { return (representative[t] >> k & 1) != 0; }
  bool represents_edge(int t, int k) const { return (representative[t] >> (3 + k) & 1) != 0; }
};

/// Bounding boxes of a surface's linear motion from x0 to x1, inflated by `margin` [m].
struct SweptBoxes {
  std::vector<Box> vertices, triangles;

  /// Bounds the motion of `surface` from x0 to x1 (n×3) [m].
  void update(const Surface& surface, const Positions& x0, const Positions& x1, double margin);
  Box edge(const Surface& surface, int e) const {
    Box box = vertices[surface.edges(e, 0)];
    box.include(vertices[surface.edges(e, 1)]);
    return box;
  }
};

}  // namespace drape
