#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/patterns/generate.h"

/// Adds vertices [m] and triangles to a mesh.
inline void append(drape::TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& vertices,
                   const std::vector<Eigen::Vector3i>& triangles) {
  Eigen::Index v = mesh.vertices.rows(), t = mesh.triangles.rows();
  mesh.vertices.conservativeResize(v + static_cast<Eigen::Index>(vertices.size()), 3);
  mesh.triangles.conservativeResize(t + static_cast<Eigen::Index>(triangles.size()), 3);
  for (const Eigen::Vector3d& x : vertices) mesh.vertices.row(v++) = x;
  for (const Eigen::Vector3i& corners : triangles) mesh.triangles.row(t++) = corners;
}

/// The vertices of a flat mesh, rolled to a cylinder of this radius along one of its axes.
inline drape::Positions rolled(drape::Positions x, double radius, int axis = 0) {
  for (auto vertex : x.rowwise()) {
    const double angle = vertex[axis] / radius;
    vertex[axis] = radius * std::sin(angle);
    vertex[2] = radius * (1 - std::cos(angle));
  }
  return x;
}

/// A disc of radius 1 that is shaped by its distance r from the middle: the place is (p/r · out, up).
template <class Shape>
drape::TriangleMesh shaped_disc(int vertices, const Shape& shape) {
  drape::TriangleMesh mesh = drape::disc(1, vertices);
  for (auto x : mesh.vertices.rowwise()) {
    const double r = x.norm();
    const Eigen::Vector2d out_up = shape(r);
    if (r > 0) x *= out_up.x() / r;
    x[2] = out_up.y();
  }
  return mesh;
}

/// Half a sphere with a radius of 0.1 m about the origin, open below.
inline drape::TriangleMesh hemisphere(int vertices) {
  return shaped_disc(vertices, [](double r) {
    return Eigen::Vector2d(.1 * std::sin(r * M_PI / 2), .1 * std::cos(r * M_PI / 2));
  });
}

inline drape::TriangleMesh mesh_of(const std::vector<Eigen::Vector3d>& vertices,
                                   const std::vector<Eigen::Vector3i>& triangles) {
  drape::TriangleMesh mesh;
  append(mesh, vertices, triangles);
  return mesh;
}

/// Both in one mesh, which nothing connects; the second one's vertices follow, moved.
inline drape::TriangleMesh both_of(const drape::TriangleMesh& first, const drape::TriangleMesh& second,
                                   const Eigen::RowVector3d& move) {
  const Eigen::Index n = first.vertices.rows();
  drape::TriangleMesh both{drape::Positions(n + second.vertices.rows(), 3),
                           drape::Triangles(first.triangles.rows() + second.triangles.rows(), 3)};
  both.vertices << first.vertices, second.vertices.rowwise() + move;
  both.triangles << first.triangles, (second.triangles.array() + static_cast<int>(n)).matrix();
  return both;
}

/// A square sheet of n × n vertices around the origin.
inline drape::Level square_sheet(int n, double side) {
  drape::TriangleMesh mesh = drape::grid({side, side}, n, n, drape::Diagonals::criss_cross);
  mesh.vertices.rowwise() -= Eigen::RowVector3d(side / 2, side / 2, 0);
  return drape::Level::of(0, mesh);
}

/// A regular polygon around the origin, vertex 0, with a triangle for each corner.
inline drape::TriangleMesh wheel(int spokes) {
  drape::TriangleMesh mesh{drape::Positions::Zero(spokes + 1, 3), drape::Triangles(spokes, 3)};
  for (int i = 0; i < spokes; ++i) {
    const double angle = 2 * M_PI * i / spokes;
    mesh.vertices.row(i + 1) << std::cos(angle), std::sin(angle), 0;
    mesh.triangles.row(i) << 0, 1 + i, 1 + (i + 1) % spokes;
  }
  return mesh;
}

/// Closed, with four vertices.
inline drape::TriangleMesh tetrahedron() {
  return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

/// Within a closed mesh; positive if its triangles face outwards.
inline double volume_of(const drape::TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles.rowwise())
    volume += Eigen::Matrix3d(mesh.vertices({t[0], t[1], t[2]}, Eigen::all)).determinant() / 6;
  return volume;
}
