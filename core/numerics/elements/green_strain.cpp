#include "core/numerics/elements/green_strain.h"

#include "core/numerics/elements/stretch.h"

namespace drape {
namespace {

/// The axis within a plane with this normal; where it is the normal, the next one of the frame.
Eigen::Vector3d projected(Eigen::Vector3d axis, const Eigen::Vector3d& normal) {
  for (int turn = 0;; ++turn) {
    const Eigen::Vector3d own = axis - axis.dot(normal) * normal;
    if (turn == 2 || own.norm() > 1e-6 * axis.norm()) return own.normalized();
    axis = Eigen::Vector3d(axis[2], axis[0], axis[1]);
  }
}

MaterialTriangle material_triangle(const Eigen::Vector3d& axis, const Level& level, int t) {
  const double area = RestTriangle::of(level, t).area;  // refuses one without area
  const auto v = level.rest.triangles.row(t);
  const Positions& x = level.rest.vertices;
  const Eigen::Vector3d e1 = x.row(v[1]) - x.row(v[0]), e2 = x.row(v[2]) - x.row(v[0]);
  const Eigen::Vector3d normal = e1.cross(e2).normalized(), first = projected(axis, normal),
                        second = normal.cross(first),
                        centroid = (x.row(v[0]) + x.row(v[1]) + x.row(v[2])) / 3;
  Eigen::Matrix2d edges;
  edges << first.dot(e1), first.dot(e2), second.dot(e1), second.dot(e2);
  const double det = edges(0, 0) * edges(1, 1) - edges(0, 1) * edges(1, 0);
  MaterialTriangle triangle;
  triangle << edges(1, 1) / det, -edges(1, 0) / det, -edges(0, 1) / det, edges(0, 0) / det, area, centroid;
  return triangle;
}

}  // namespace

std::vector<MaterialTriangle> material_triangles(const Eigen::Vector3d& axis, const Level& level) {
  std::vector<MaterialTriangle> triangles;
  for (int t = 0; t < level.triangle_count(); ++t) triangles.push_back(material_triangle(axis, level, t));
  return triangles;
}

}  // namespace drape
