#include "core/numerics/formulas/fold_formula.h"

#include <Eigen/Geometry>

#include "core/numerics/elements/rest_hinge.h"

namespace drape {
namespace {

RestHinge rest_hinge(const Level& level, Eigen::Index h) {
  const auto vertices = level.hinges.row(h);
  const Positions& x = level.rest.vertices;
  const auto d = vectors_in_space(level, h);
  const double length = d[0].norm(), area1 = d[0].cross(d[1]).norm() / 2, area2 = d[0].cross(d[2]).norm() / 2;
  const Eigen::Vector3d midpoint = (x.row(vertices[0]) + x.row(vertices[1])) / 2;
  RestHinge rest;
  rest << DihedralAngle<double>(d.data()).angle(), length, 2 * area1 / length, 2 * area2 / length,
      area1 + area2, midpoint;
  if (!rest.allFinite() || !(area1 > 0) || !(area2 > 0))
    throw std::runtime_error("a triangle at the edge of vertices " + std::to_string(vertices[0]) + " and " +
                             std::to_string(vertices[1]) + " of level " + std::to_string(level.index) +
                             " has no area at rest");
  return rest;
}

}  // namespace

std::vector<RestHinge> rest_hinges(const Level& level) {
  if (level.rest.sewing) return flat_rest_hinges(level);
  std::vector<RestHinge> hinges;
  for (Eigen::Index h = 0; h < level.hinges.rows(); ++h) hinges.push_back(rest_hinge(level, h));
  return hinges;
}

}  // namespace drape
