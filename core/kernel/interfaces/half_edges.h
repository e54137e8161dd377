#pragma once

#include <algorithm>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

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

}  // namespace drape
