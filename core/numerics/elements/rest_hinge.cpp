#include "core/numerics/elements/rest_hinge.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/numerics/mesh/seams.h"

namespace drape {

std::array<Eigen::Vector3d, 3> rest_vectors(const Level& level, Eigen::Index hinge) {
  std::array<Eigen::Vector3d, 3> d;
  const TriangleMesh& rest = level.rest;
  if (!rest.sewing) {
    const auto v = level.hinges.row(hinge);
    for (int i = 0; i < 3; ++i) d[i] = rest.vertices.row(v[i + 1]) - rest.vertices.row(v[0]);
    return d;
  }
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

double stiffness_factor(const Level& level, Eigen::Index hinge) {
  const auto& sewing = level.rest.sewing;
  return sewing && is_seam(level.rest, level.topology, level.hinge_edges[hinge]) ? sewing->seam_stiffness : 1;
}

}  // namespace drape
