#include "core/app/picture/surface.h"

#include <vector>

#include "core/numerics/mesh/area_vectors.h"

namespace drape {

Positions smooth_normals(const TriangleMesh& mesh) {
  const Positions areas = area_vectors(mesh);
  Positions normals = Positions::Zero(mesh.vertices.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    if (areas.row(t).allFinite())
      for (int k = 0; k < 3; ++k) normals.row(mesh.triangles(t, k)) += areas.row(t);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) normals.row(i).normalize();
  return normals;
}

TriangleMesh split_at_creases(const TriangleMesh& mesh, Positions& normals) {
  constexpr double cosine_of_crease = 0.766;
  const Eigen::Index m = mesh.triangles.rows();
  const Positions areas = area_vectors(mesh);
  std::vector<std::vector<int>> around(mesh.vertices.rows());
  for (Eigen::Index t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) around[mesh.triangles(t, k)].push_back(static_cast<int>(t));
  TriangleMesh split{Positions(3 * m, 3), Triangles(m, 3)};
  normals = Positions::Zero(3 * m, 3);
  for (Eigen::Index t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) {
      const int i = mesh.triangles(t, k), corner = static_cast<int>(3 * t) + k;
      split.triangles(t, k) = corner;
      split.vertices.row(corner) = mesh.vertices.row(i);
      for (const int other : around[i])
        if (areas.row(t).dot(areas.row(other)) >=
            cosine_of_crease * areas.row(t).norm() * areas.row(other).norm())
          normals.row(corner) += areas.row(other);
      normals.row(corner).normalize();
    }
  return split;
}

}  // namespace drape
