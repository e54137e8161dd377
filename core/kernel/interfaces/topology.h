#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Rows of items in one array: row i is items[start[i]] … items[start[i + 1] - 1].
template <class Item>
struct Grouped {
  std::vector<int> start;
  std::vector<Item> items;

  const Item* begin(int row) const { return items.data() + start[row]; }
  const Item* end(int row) const { return items.data() + start[row + 1]; }
  int size(int row) const { return start[row + 1] - start[row]; }
  std::span<const Item> row(int i) const { return {begin(i), end(i)}; }
  std::span<Item> row(int i) { return {items.data() + start[i], items.data() + start[i + 1]}; }

  /// Row by row the items that visit(add) gives by add(row, item), in its order, in two equal calls.
  template <class Visit>
  static Grouped of(int row_count, const Visit& visit) {
    Grouped list{std::vector<int>(row_count + 1, 0), {}};
    visit([&](int row, const Item&) { ++list.start[row + 1]; });
    std::partial_sum(list.start.begin(), list.start.end(), list.start.begin());
    list.items.resize(list.start.back());
    std::vector<int> end(list.start.begin(), list.start.end() - 1);
    visit([&](int row, const Item& item) { list.items[end[row]++] = item; });
    return list;
  }
};

/// Rows of neighbours, by their indices.
using AdjacencyList = Grouped<int>;

/// One side of a triangle, in the triangle's direction. Half-edge number 3t + k is the side of triangle t
/// opposite its vertex k.
struct HalfEdge {
  int from;
  int to;

  static HalfEdge of(const Triangles& triangles, int number) {
    const int t = number / 3, k = number % 3;
    return {triangles(t, (k + 1) % 3), triangles(t, (k + 2) % 3)};
  }
  int smaller() const { return std::min(from, to); }
  int larger() const { return std::max(from, to); }
  bool same_edge(const HalfEdge& o) const { return smaller() == o.smaller() && larger() == o.larger(); }
};

/// All half-edge numbers, ordered by edge (smaller end, then larger), then by number. Linear time.
/// Indices must be in 0 … vertex_count - 1.
std::vector<int> half_edges_by_edge(const Triangles& triangles, int vertex_count);

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
  /// For triangles that need not be manifold, as an obstacle's.
  static Topology of_any(const Triangles& triangles, int vertex_count);

  /// The corner of a triangle that lies opposite one of its edges, 0 … 2.
  int corner_opposite(int edge, int triangle) const {
    return triangle_edges(triangle, 0) == edge ? 0 : triangle_edges(triangle, 1) == edge ? 1 : 2;
  }
  /// h×4 stencils of the inner edges: edge ends (0, 1), then the vertices opposite it in its two
  /// triangles, so that triangles (0, 1, 2) and (1, 0, 3) have the mesh's orientation.
  Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor> hinges(const Triangles& triangles) const;
};

}  // namespace drape
