#include "core/numerics/elements/vertex_fields.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/elements/stretch.h"

namespace drape {

namespace {

/// The normal of triangle (a, b, c), of length twice its area.
Eigen::Vector3d twice_normal(const Positions& x, int a, int b, int c) {
  const Eigen::Vector3d e1 = x.row(b) - x.row(a), e2 = x.row(c) - x.row(a);
  return e1.cross(e2);
}

}  // namespace

Eigen::VectorXd mean_curvature(const Positions& x, const Triangles& triangles, const Stencils& hinges) {
  Eigen::VectorXd area = Eigen::VectorXd::Zero(x.rows()), sum = area;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const auto v = triangles.row(t);
    const double third = twice_normal(x, v[0], v[1], v[2]).norm() / 6;
    for (int k = 0; k < 3; ++k) area[v[k]] += third;
  }
  for (Eigen::Index e = 0; e < hinges.rows(); ++e) {
    const auto h = hinges.row(e);
    const Eigen::Vector3d edge = x.row(h[1]) - x.row(h[0]);
    const Eigen::Vector3d n1 = twice_normal(x, h[0], h[1], h[2]), n2 = twice_normal(x, h[1], h[0], h[3]);
    const double length = edge.norm();
    const double angle = std::atan2(n1.cross(n2).dot(edge), length * n1.dot(n2));
    for (int k = 0; k < 2; ++k) sum[h[k]] += 0.25 * length * angle;
  }
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    sum[i] = area[i] > 0 ? sum[i] / area[i] : std::numeric_limits<double>::quiet_NaN();
  return sum;
}

Eigen::VectorXd largest_stretch(const Level& level, const Positions& x) {
  const Triangles& triangles = level.rest.triangles;
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(x.rows());
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = triangles.row(t);
    const double stretch =
        RestTriangle::of(level, t).stretch(x.row(v[1]) - x.row(v[0]), x.row(v[2]) - x.row(v[0])).largest;
    for (int k = 0; k < 3; ++k) largest[v[k]] = std::max(largest[v[k]], stretch);
  }
  return largest;
}

}  // namespace drape
