#pragma once

#include <cmath>
#include <vector>

#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/mesh/split_triangles.h"

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
      mesh = {all, drape::split_triangles(mesh.triangles, coarse.topology)};
    }
    mesh.vertices.rowwise().normalize();
  }
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
  mesh.vertices.row(0) << 0, 0, bulge;
  for (int k = 1; k <= rings; ++k)
    for (int j = 0; j < meridians; ++j) {
      const double r = static_cast<double>(k) / rings, angle = 2 * M_PI * j / meridians;
      mesh.vertices.row(1 + j + meridians * (k - 1)) << radius * r * std::cos(angle),
          radius * r * std::sin(angle), bulge * (1 - r * r);
    }
  for (int v = 0; v < inner; ++v)
    mesh.vertices.row(all + v) = mesh.vertices.row(v).cwiseProduct(Eigen::RowVector3d(1, 1, -1));
  const auto at = [&](int k, int j) { return k == 0 ? 0 : 1 + j % meridians + meridians * (k - 1); };
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
      if (j % 2 == 0) {
        add(in, out, in_next);
        add(in_next, out, out_next);
      } else {
        add(in, out, out_next);
        add(in, out_next, in_next);
      }
    }
  }
  return mesh;
}
