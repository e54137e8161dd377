#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

// Surfaces of plane faces, in space and as flat pieces.

/// A surface of n plane faces about z, between rings of these radii and heights, open at its ends; a first
/// radius of 0 makes an apex. Its front is outside where rings rise.
inline drape::TriangleMesh faceted(int n, const std::vector<Eigen::Vector2d>& rings) {
  drape::TriangleMesh mesh;
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<Eigen::RowVector3i> triangles;
  const bool apex = rings[0].x() == 0;
  const auto vertex = [&](int ring, int k) {
    return apex ? (ring == 0 ? 0 : 1 + (ring - 1) * n + k % n) : ring * n + k % n;
  };
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (int k = 0; k < (apex && r == 0 ? 1 : n); ++k)
      vertices.emplace_back(rings[r].x() * std::cos(2 * M_PI * k / n),
                            rings[r].x() * std::sin(2 * M_PI * k / n), rings[r].y());
  for (int r = 0; r + 1 < static_cast<int>(rings.size()); ++r)
    for (int k = 0; k < n; ++k) {
      if (!apex || r > 0) triangles.emplace_back(vertex(r, k), vertex(r, k + 1), vertex(r + 1, k + 1));
      triangles.emplace_back(vertex(r, k), vertex(r + 1, k + 1), vertex(r + 1, k));
    }
  mesh.vertices.resize(std::ssize(vertices), 3);
  mesh.triangles.resize(std::ssize(triangles), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) mesh.vertices.row(i) = vertices[i];
  for (std::size_t i = 0; i < triangles.size(); ++i) mesh.triangles.row(i) = triangles[i];
  return mesh;
}

/// Such a surface as flat pieces, one for each plane face, with this angle at the seams.
inline drape::TriangleMesh as_facets(drape::TriangleMesh mesh, int n, double angle) {
  struct Frame {
    Eigen::Vector3d origin, along, across;
  };
  std::map<int, Frame> frames;
  mesh.uv.resize(mesh.triangles.rows(), 6);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const auto at = [&](int k) -> Eigen::Vector3d { return mesh.vertices.row(mesh.triangles(t, k)); };
    const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized(),
                          along = (at(1) - at(0)).normalized();
    const int face = static_cast<int>(std::floor(std::atan2(normal.y(), normal.x()) * n / (2 * M_PI)));
    const Frame& frame = frames.try_emplace(face, Frame{at(0), along, normal.cross(along)}).first->second;
    for (int k = 0; k < 3; ++k)
      mesh.uv.block<1, 2>(t, 2 * k) << frame.along.dot(at(k) - frame.origin) + face,
          frame.across.dot(at(k) - frame.origin);
  }
  mesh.sewing = drape::Sewing{1, angle, 1};
  return mesh;
}

/// The cone of a regular polygon without a sector of this angle: n plane faces between an apex and three
/// rings, whose spokes are `step` apart.
inline drape::TriangleMesh faceted_cone(int n, double removed, double step) {
  const double sine = std::sin((2 * M_PI - removed) / (2 * n)) / std::sin(M_PI / n);  // of its half angle
  const Eigen::Vector2d ring(step * sine, -step * std::sqrt(1 - sine * sine));
  return faceted(n, {{0, 0}, ring, 2 * ring, 3 * ring});
}

/// Such a cone as one flat piece, sewn along its first spoke.
inline drape::TriangleMesh as_sector(drape::TriangleMesh cone, int n, double removed, double step) {
  cone.uv.resize(cone.triangles.rows(), 6);
  for (Eigen::Index t = 0; t < cone.uv.rows(); ++t) {
    const auto v = cone.triangles.row(t);
    bool last = false, first = false;
    for (const int own : v)
      last = last || (own > 0 && (own - 1) % n == n - 1), first = first || (own > 0 && (own - 1) % n == 0);
    for (int k = 0; k < 3; ++k) {
      const int spoke = v[k] == 0 ? 0 : (v[k] - 1) % n;
      const double angle = (2 * M_PI - removed) / n * (last && first && spoke == 0 ? n : spoke),
                   slant = v[k] == 0 ? 0 : step * (1 + (v[k] - 1) / n);
      cone.uv.block<1, 2>(t, 2 * k) << slant * std::cos(angle), slant * std::sin(angle);
    }
  }
  cone.sewing = drape::Sewing{};
  return cone;
}
