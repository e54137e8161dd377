#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Rows of neighbours in one array: row i is items[start[i]] … items[start[i + 1] - 1].
struct AdjacencyList {
  std::vector<int> start;
  std::vector<int> items;

  const int* begin(int row) const { return items.data() + start[row]; }
  const int* end(int row) const { return items.data() + start[row + 1]; }
  int size(int row) const { return start[row + 1] - start[row]; }
};

/// Edges and adjacency of a triangle mesh, derived once from its triangles.
/// Deterministic: edges are numbered in order of first appearance in triangle_edges, row by row.
struct Topology {
  /// e×2 end vertices of each edge, smaller index first.
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges;
  /// m×3 edge indices; column k is the edge opposite vertex k of the triangle.
  Triangles triangle_edges;
  /// e×2 triangles of each edge, of more the first two; -1 in column 1 on the border.
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edge_triangles;
  /// n flags, 1 where the vertex lies on the border.
  std::vector<char> on_border;
  /// Neighbouring vertices of each vertex, ascending.
  AdjacencyList vertex_vertices;
  /// Triangles around each vertex, ascending.
  AdjacencyList vertex_triangles;

  /// Builds all of the above in linear time. `triangles` must be manifold (see check_mesh); throws
  /// std::runtime_error on an index out of range, a repeated one or an edge with more than two triangles.
  static Topology of(const Triangles& triangles, int vertex_count);
  /// The same of triangles that need not be manifold, as an obstacle's.
  static Topology of_any(const Triangles& triangles, int vertex_count);

  /// The first vertex of each connected component, ascending.
  std::vector<int> components() const;

  /// h×4 stencils of the inner edges: edge ends (0, 1), then the vertices opposite it in its two
  /// triangles, so that triangles (0, 1, 2) and (1, 0, 3) have the mesh's orientation.
  Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor> hinges(const Triangles& triangles) const;
};

}  // namespace drape
