#pragma once

#include <string>
#include <vector>

#include "core/kernel/mesh/cut_polygon.h"
#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// A mesh that grows while a file is read.
struct MeshBuilder {
  std::vector<double> coordinates;  ///< 3n
  std::vector<int> corners;         ///< 3m
  int face_count = 0;

  int vertex_count() const { return static_cast<int>(coordinates.size() / 3); }

  /// Adds the triangles of a face of at least three vertices, all of which are there. Calls
  /// refuse("face 7 (counted from 0) …") if it cannot be cut. Returns the triangles as indices into the face.
  template <class Refuse>
  std::vector<std::array<int, 3>> add_face(const std::vector<int>& face, const Refuse& refuse) {
    const int number = face_count++;
    std::vector<Eigen::Vector3d> points;
    if (face.size() > 3)
      for (const int v : face) points.emplace_back(&coordinates[3 * static_cast<std::size_t>(v)]);
    CutPolygon cut = face.size() == 3 ? CutPolygon{{{0, 1, 2}}, {}} : cut_polygon(points);
    if (!cut.fault.empty()) refuse("face " + std::to_string(number) + " (counted from 0) " + cut.fault);
    for (const auto& triangle : cut.triangles)
      for (const int k : triangle) corners.push_back(face[k]);
    return std::move(cut.triangles);
  }

  TriangleMesh mesh() const {
    return {
        Eigen::Map<const Positions>(coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3),
        Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3)};
  }
};

}  // namespace drape
