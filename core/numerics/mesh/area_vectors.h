#pragma once

#include <Eigen/Geometry>
#include <algorithm>

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

/// n thirds of the area of the triangles at each vertex [m²].
inline Eigen::VectorXd vertex_areas(const TriangleMesh& mesh) {
  const Positions areas = area_vectors(mesh);
  Eigen::VectorXd thirds = Eigen::VectorXd::Zero(mesh.vertices.rows());
  for (Eigen::Index t = 0; t < areas.rows(); ++t)
    for (const int v : mesh.triangles.row(t)) thirds[v] += areas.row(t).norm() / 6;
  return thirds;
}

/// The height of a triangle over its longest edge, which is its base; its corners are the columns.
inline double relative_height(const Eigen::Matrix3d& corners) {
  const Eigen::Vector3d a = corners.col(1) - corners.col(0), b = corners.col(2) - corners.col(0);
  return a.cross(b).norm() / std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
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
