#pragma once

#include "core/kernel/mesh/triangle_mesh.h"

/// n × n vertices over the unit square at z = 0, row by row, each cell split along the diagonal from its
/// first corner.
inline drape::TriangleMesh flat_sheet(int n) {
  drape::TriangleMesh mesh{drape::Positions(n * n, 3), drape::Triangles(2 * (n - 1) * (n - 1), 3)};
  for (int i = 0; i < n * n; ++i) mesh.vertices.row(i) << (i % n) / (n - 1.0), (i / n) / (n - 1.0), 0;
  for (int i = 0, t = 0; i < n * (n - 1); ++i) {
    if (i % n == n - 1) continue;
    mesh.triangles.row(t++) << i, i + 1, i + n + 1;
    mesh.triangles.row(t++) << i, i + n + 1, i + n;
  }
  return mesh;
}
