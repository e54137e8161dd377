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

}  // namespace drape
