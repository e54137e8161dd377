#pragma once

#include <vector>

#include "core/contact/box.h"
#include "core/mesh/topology.h"

namespace drape {

/// A triangle surface as contact sees it: rest areas and lengths, and which triangle each vertex and edge is
/// looked up through, so that pairs of triangles yield every pair of primitives once (Curtis et al. 2008,
/// "representative triangles").
struct Surface {
  Triangles triangles;
  Triangles triangle_edges;  ///< column k: the edge opposite vertex k
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges;
  std::vector<char> owned;  ///< a triangle's bits: k for its vertex k, 3 + k for the edge opposite it
  Eigen::VectorXd vertex_area, edge_area, triangle_area;  ///< thirds of adjacent rest areas; its own [m²]
  Eigen::VectorXd edge_length_squared;                    ///< at rest [m²]

  static Surface of(const TriangleMesh& rest, const Topology& topology);
  /// Adds another surface, whose vertices, edges and triangles follow this one's.
  void append(const Surface& other);

  int triangle_count() const { return static_cast<int>(triangles.rows()); }
  bool owns_vertex(int t, int k) const { return (owned[t] >> k & 1) != 0; }
  bool owns_edge(int t, int k) const { return (owned[t] >> (3 + k) & 1) != 0; }
};

/// Boxes of a surface that moves straight from x0 to x1, each `margin` larger than what it holds.
struct SweptBoxes {
  std::vector<Box> vertices, triangles;

  void update(const Surface& surface, const Positions& x0, const Positions& x1, double margin);
  Box edge(const Surface& surface, int e) const {
    Box box = vertices[surface.edges(e, 0)];
    box.include(vertices[surface.edges(e, 1)]);
    return box;
  }
};

}  // namespace drape
