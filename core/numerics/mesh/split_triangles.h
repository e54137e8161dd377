#pragma once

#include "core/kernel/interfaces/topology.h"

namespace drape {

/// 1→4 split of n vertices' triangles: edge e gets vertex n + e. Triangle t becomes 4t + k at its corner k,
/// for k = 0, 1, 2, and the central triangle 4t + 3; all keep t's orientation.
inline Triangles split_triangles(const Triangles& coarse, const Topology& topology) {
  const int n = static_cast<int>(topology.on_border.size());
  Triangles children(4 * coarse.rows(), 3);
  for (Eigen::Index t = 0; t < coarse.rows(); ++t) {
    const auto v = coarse.row(t);
    const auto e = topology.triangle_edges.row(t);  // e[k] is opposite v[k]
    children.row(4 * t + 0) << v[0], n + e[2], n + e[1];
    children.row(4 * t + 1) << n + e[2], v[1], n + e[0];
    children.row(4 * t + 2) << n + e[1], n + e[0], v[2];
    children.row(4 * t + 3) << n + e[0], n + e[1], n + e[2];
  }
  return children;
}

}  // namespace drape
