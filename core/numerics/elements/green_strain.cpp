#include "core/numerics/elements/green_strain.h"

#include <Eigen/LU>

#include "core/numerics/elements/stretch.h"
#include "core/numerics/mesh/grain.h"

namespace drape {
namespace {

MaterialTriangle material_triangle(const Eigen::Vector3d& first, const Level& level, int t) {
  const double area = RestTriangle::of(level, t).area;  // refuses one without area
  const auto v = level.rest.triangles.row(t);
  const Positions& x = level.rest.vertices;
  const Eigen::Vector3d e1 = x.row(v[1]) - x.row(v[0]), e2 = x.row(v[2]) - x.row(v[0]);
  const Eigen::Vector3d second = e1.cross(e2).normalized().cross(first),
                        centroid = (x.row(v[0]) + x.row(v[1]) + x.row(v[2])) / 3;
  Eigen::Matrix2d edges;
  edges << first.dot(e1), first.dot(e2), second.dot(e1), second.dot(e2);
  const double det = edges(0, 0) * edges(1, 1) - edges(0, 1) * edges(1, 0);
  MaterialTriangle triangle;
  triangle << edges(1, 1) / det, -edges(1, 0) / det, -edges(0, 1) / det, edges(0, 0) / det, area, centroid;
  return triangle;
}

std::vector<MaterialTriangle> flat_material_triangles(const Level& level) {
  const Positions warp = warp_directions(level.rest);
  std::vector<MaterialTriangle> triangles;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const Eigen::Matrix3d x = rest_corners(level.rest, t);
    Eigen::Matrix2d axes, edges;
    axes << warp(t, 0), warp(t, 1), -warp(t, 1), warp(t, 0);
    edges << (x.col(1) - x.col(0)).head<2>(), (x.col(2) - x.col(0)).head<2>();
    const Eigen::Matrix2d inverse = (axes * edges).inverse();
    triangles.emplace_back() << inverse(0, 0), inverse(1, 0), inverse(0, 1), inverse(1, 1),
        RestTriangle::of(level, t).area, x.rowwise().mean();
  }
  return triangles;
}

}  // namespace

std::vector<MaterialTriangle> material_triangles(const Level& level) {
  if (level.rest.sewing) return flat_material_triangles(level);
  const Positions warp = warp_directions(level.rest);
  std::vector<MaterialTriangle> triangles;
  for (int t = 0; t < level.triangle_count(); ++t)
    triangles.push_back(material_triangle(warp.row(t), level, t));
  return triangles;
}

}  // namespace drape
