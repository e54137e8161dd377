#pragma once

#include <cmath>

#include "core/numerics/patterns/generate.h"

// Closed meshes to blow up, triangles counter-clockwise seen from outside.

/// A sphere about the origin with 20 · 4^splits triangles.
inline drape::TriangleMesh sphere_mesh(double radius, int splits) {
  drape::TriangleMesh mesh = drape::unit_sphere(splits);
  mesh.vertices *= radius;
  return mesh;
}

/// Two discs about the z axis, joined at their rims, of `rings` rings around a vertex in the middle, thick by
/// 2 · `bulge` there. Vertex 1 + j + meridians · (k - 1) is on ring k at the angle 2π j / meridians of the
/// upper disc, the rim being the last ring; the lower disc's inner vertices follow in the same order.
/// Diagonals end inwards at odd meridians, so that every meridian is a mirror when their number is even.
inline drape::TriangleMesh cushion_mesh(double radius, int meridians, int rings, double bulge) {
  const int inner = 1 + meridians * (rings - 1), all = inner + meridians;
  drape::TriangleMesh mesh;
  mesh.vertices.resize(all + inner, 3);
  mesh.triangles.resize(2 * meridians * (2 * rings - 1), 3);
  const auto at = [&](int k, int j) { return k == 0 ? 0 : 1 + j % meridians + meridians * (k - 1); };
  for (int k = 0; k <= rings; ++k)
    for (int j = 0; j < meridians; ++j) {
      const double r = static_cast<double>(k) / rings, angle = 2 * M_PI * j / meridians;
      mesh.vertices.row(at(k, j)) << radius * r * std::cos(angle), radius * r * std::sin(angle),
          bulge * (1 - r * r);
    }
  mesh.vertices.bottomRows(inner) = mesh.vertices.topRows(inner);
  mesh.vertices.bottomRows(inner).col(2) *= -1;
  const auto below = [&](int v) { return v < inner ? all + v : v; };
  Eigen::Index next = 0;
  const auto add = [&](int a, int b, int c) {
    mesh.triangles.row(next++) << a, b, c;
    mesh.triangles.row(next++) << below(a), below(c), below(b);
  };
  for (int j = 0; j < meridians; ++j) {
    add(0, at(1, j), at(1, j + 1));
    for (int k = 1; k < rings; ++k) {
      const int in = at(k, j), in_next = at(k, j + 1), out = at(k + 1, j), out_next = at(k + 1, j + 1);
      add(in, out, j % 2 ? out_next : in_next);
      add(j % 2 ? in : out, out_next, in_next);
    }
  }
  return mesh;
}
