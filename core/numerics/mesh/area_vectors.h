#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// m×3 normals of the triangles, of the length of twice the area [m²].
inline Positions area_vectors(const TriangleMesh& mesh) {
  Positions areas(mesh.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < areas.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.vertices.row(mesh.triangles(t, 0));
    areas.row(t) =
        (mesh.vertices.row(mesh.triangles(t, 1)) - a).cross(mesh.vertices.row(mesh.triangles(t, 2)) - a);
  }
  return areas;
}

/// n×3 unit normals, area-weighted; zero where undefined.
inline Positions smooth_normals(const TriangleMesh& mesh) {
  const Positions areas = area_vectors(mesh);
  Positions normals = Positions::Zero(mesh.vertices.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    if (areas.row(t).allFinite())
      for (int k = 0; k < 3; ++k) normals.row(mesh.triangles(t, k)) += areas.row(t);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) normals.row(i).normalize();
  return normals;
}

}  // namespace drape
