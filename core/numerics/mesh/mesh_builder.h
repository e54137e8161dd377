#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/mesh/cut_polygon.h"

namespace drape {

/// What a mesh is read for. A cloth has texture coordinates and faces of at least three corners. The surface
/// of an obstacle has no use for the former, and its faces of one or two corners become triangles that repeat
/// a vertex, which repair_mesh drops.
enum class MeshUse { cloth, surface };

/// A mesh that grows while a file is read.
struct MeshBuilder {
  MeshUse use = MeshUse::cloth;
  std::vector<double> coordinates = {};  ///< 3n
  std::vector<int> corners = {};         ///< 3m
  std::vector<double> uv = {};           ///< 6m; shorter if the last faces have none
  int face_count = 0;

  std::size_t fewest_corners() const { return use == MeshUse::cloth ? 3 : 1; }
  int vertex_count() const { return static_cast<int>(coordinates.size() / 3); }

  /// Adds the triangles of a face of at least fewest_corners() vertices, all of which are there, with the
  /// texture coordinates u and v of each corner, or none. Calls refuse("face 7 (counted from 0) …") if it
  /// cannot be cut.
  template <class Refuse>
  void add_face(const std::vector<int>& face, const std::vector<double>& face_uv, const Refuse& refuse) {
    const int number = face_count++;
    std::vector<Eigen::Vector3d> points;
    if (face.size() > 3)
      for (const int v : face) points.emplace_back(&coordinates[3 * static_cast<std::size_t>(v)]);
    const CutPolygon cut = face.size() > 3 ? cut_polygon(points) : CutPolygon{{{0, 1, 2}}, {}};
    if (!cut.fault.empty()) refuse("face " + std::to_string(number) + " (counted from 0) " + cut.fault);
    if (!face_uv.empty()) uv.resize(2 * corners.size());  // (0, 0) for faces before that have none
    for (const auto& triangle : cut.triangles)
      for (const int k : triangle) {
        corners.push_back(face[std::min<std::size_t>(k, face.size() - 1)]);
        if (!face_uv.empty()) uv.insert(uv.end(), {face_uv[2 * k], face_uv[2 * k + 1]});
      }
  }

  TriangleMesh mesh() const {
    TriangleMesh mesh{
        Eigen::Map<const Positions>(coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3),
        Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3)};
    if (uv.empty()) return mesh;
    mesh.uv.setZero(mesh.triangles.rows(), 6);
    std::copy(uv.begin(), uv.end(), mesh.uv.data());
    return mesh;
  }
};

}  // namespace drape
