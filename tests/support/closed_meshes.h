#pragma once

#include <cmath>
#include <vector>

#include "core/hierarchy/midpoint.h"

// Closed meshes to blow up, triangles counter-clockwise seen from outside.

/// A sphere about the origin with 20 · 4^splits triangles: an icosahedron, split, every vertex on the sphere.
inline drape::TriangleMesh sphere_mesh(double radius, int splits) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  drape::TriangleMesh mesh;
  mesh.vertices.resize(12, 3);
  mesh.vertices << -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, 0, 0, -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, g, 0, -1,
      g, 0, 1, -g, 0, -1, -g, 0, 1;
  mesh.triangles.resize(20, 3);
  mesh.triangles << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6,
      7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1;
  for (int s = 0; s <= splits; ++s) {
    if (s > 0) {
      const drape::Level coarse = drape::Level::of(0, mesh);
      drape::Positions all(coarse.vertex_count() + coarse.topology.edges.rows(), 3);
      all.topRows(coarse.vertex_count()) = mesh.vertices;
      for (Eigen::Index e = 0; e < coarse.topology.edges.rows(); ++e)
        all.row(coarse.vertex_count() + e) = (mesh.vertices.row(coarse.topology.edges(e, 0)) +
                                              mesh.vertices.row(coarse.topology.edges(e, 1))) /
                                             2;
      mesh = {all, drape::split_triangles(coarse)};
    }
    mesh.vertices.rowwise().normalize();
  }
  mesh.vertices *= radius;
  return mesh;
}

/// Two discs about the z axis, joined at their rims: `rings` rings of 6 k vertices on either side, thick by
/// 2 · `bulge` in the middle.
inline drape::TriangleMesh cushion_mesh(double radius, int rings, double bulge) {
  const int inner = 1 + 3 * rings * (rings - 1), rim = 6 * rings;
  drape::TriangleMesh mesh;
  mesh.vertices.resize(2 * inner + rim, 3);  // upper disc with the rim, then the lower one's inside
  mesh.triangles.resize(2 * 6 * rings * rings, 3);
  const auto start = [](int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
  const auto below = [&](int v) { return v < inner ? inner + rim + v : v; };
  Eigen::Index next = 0;
  const auto add = [&](int a, int b, int c) {
    mesh.triangles.row(next++) << a, b, c;
    mesh.triangles.row(next++) << below(a), below(c), below(b);
  };
  for (int k = 0; k <= rings; ++k) {
    const int count = std::max(1, 6 * k);
    for (int i = 0; i < count; ++i) {
      const double r = radius * k / rings, angle = 2 * M_PI * i / count;
      mesh.vertices.row(start(k) + i) << r * std::cos(angle), r * std::sin(angle),
          bulge * (1 - r * r / (radius * radius));
    }
  }
  for (int k = 1; k <= rings; ++k)
    for (int side = 0; side < 6; ++side)
      for (int i = 0; i < k; ++i) {
        const auto outer = [&](int j) { return start(k) + (side * k + j) % (6 * k); };
        const auto within = [&](int j) {
          return k == 1 ? 0 : start(k - 1) + (side * (k - 1) + j) % (6 * (k - 1));
        };
        add(outer(i), outer(i + 1), within(i));
        if (i + 1 < k) add(within(i), outer(i + 1), within(i + 1));
      }
  for (int v = 0; v < inner; ++v)
    mesh.vertices.row(below(v)) = mesh.vertices.row(v).cwiseProduct(Eigen::RowVector3d(1, 1, -1));
  return mesh;
}
