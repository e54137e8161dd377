#include "core/numerics/elements/rest_hinge.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/stretch.h"
#include "core/numerics/mesh/grain.h"
#include "core/numerics/mesh/seams.h"

namespace drape {

std::array<Eigen::Vector3d, 3> flat_vectors(const Level& level, Eigen::Index hinge) {
  std::array<Eigen::Vector3d, 3> d;
  const TriangleMesh& rest = level.rest;
  const int edge = level.hinge_edges[hinge];
  const double length = rest_length(rest, level.topology, edge),
               angle = is_seam(rest, level.topology, edge) ? rest.sewing->seam_angle : 0;
  d[0] = {length, 0, 0};
  for (int side = 0; side < 2; ++side) {
    const RestSide own = rest_side(rest, level.topology, edge, side);
    const Eigen::Vector3d e = own.to - own.from, p = own.corner - own.from;
    const double foot = e.dot(p) / e.squaredNorm() * length, height = e.cross(p).norm() / length;
    d[1 + side] = {foot, side == 0 ? height : -height * std::cos(angle),
                   side == 0 ? 0 : -height * std::sin(angle)};
  }
  return d;
}

std::vector<Eigen::Matrix<double, 8, 1>> flat_material_triangles(const Level& level) {
  const Positions warp = warp_directions(level.rest);
  std::vector<Eigen::Matrix<double, 8, 1>> triangles;
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

std::vector<Eigen::Matrix<double, 8, 1>> flat_rest_hinges(const Level& level) {
  std::vector<Eigen::Matrix<double, 8, 1>> hinges;
  for (Eigen::Index h = 0; h < level.hinges.rows(); ++h) {
    const auto d = flat_vectors(level, h);
    const RestSide first = rest_side(level.rest, level.topology, level.hinge_edges[h], 0);
    const double length = d[0].norm(), twice1 = d[0].cross(d[1]).norm(), twice2 = d[0].cross(d[2]).norm();
    hinges.emplace_back() << DihedralAngle<double>(d.data()).angle(), length, twice1 / length,
        twice2 / length, (twice1 + twice2) / 2, (first.from + first.to) / 2;
  }
  return hinges;
}

double stiffness_factor(const Level& level, Eigen::Index hinge) {
  const auto& sewing = level.rest.sewing;
  return sewing && is_seam(level.rest, level.topology, level.hinge_edges[hinge]) ? sewing->seam_stiffness : 1;
}

}  // namespace drape
