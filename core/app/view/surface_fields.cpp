#include "core/app/view/surface_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/collision_detection/box_tree.h"
#include "core/numerics/collision_detection/closest.h"

namespace drape {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double quantile = 0.98;  // of the values inside the colours' range

/// Lowers gap[i] to the distance of each point i to every triangle within `range` that `counts(i, t)`.
template <class Counts>
void lower_to_distance(Eigen::VectorXd& gap, const BoxTree& points, const Positions& x, const Positions& y,
                       const Triangles& triangles, double range, const Counts& counts) {
  if (triangles.rows() == 0) return;
  std::vector<Box> boxes;
  for (const auto& v : triangles.rowwise()) {
    boxes.push_back(Box::around(y.row(v[0]), y.row(v[1]), range));
    boxes.back().include(Box::around(y.row(v[2]), y.row(v[2]), range));
  }
  BoxTree tree;
  tree.build(boxes);
  for (int run = 0; run < points.runs(); ++run)
    points.overlaps(
        tree, run,
        [&](int i, int t) {
          if (!counts(i, t)) return;
          const auto v = triangles.row(t);
          const Eigen::Vector3d a = y.row(v[0]), b = y.row(v[1]), c = y.row(v[2]), p = x.row(i);
          const Eigen::Vector4d w = closest_point_triangle(p, a, b, c).c;
          gap[i] = std::min(gap[i], (w[0] * p + w[1] * a + w[2] * b + w[3] * c).norm());
        },
        [] { return false; });
}

BoxTree tree_of(const Positions& x) {
  std::vector<Box> boxes(x.rows());
  for (Eigen::Index i = 0; i < x.rows(); ++i) boxes[i] = Box::around(x.row(i), x.row(i), 0);
  BoxTree points;
  points.build(boxes);
  return points;
}

/// The quantile of all finite |values|; 0 without any.
double magnitude_quantile(const std::vector<const Eigen::VectorXd*>& fields, double quantile) {
  std::vector<double> all;
  for (const Eigen::VectorXd* field : fields)
    for (const double value : *field)
      if (std::isfinite(value)) all.push_back(std::abs(value));
  if (all.empty()) return 0;
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(quantile * (all.size() - 1));
  std::nth_element(all.begin(), place, all.end());
  return *place;
}

/// The distance of each point to the obstacles; +∞ where it is known to be beyond the range.
Eigen::VectorXd nearest_obstacle(const BoxTree& points, const Positions& x,
                                 const std::vector<TriangleMesh>& obstacles, double range) {
  Eigen::VectorXd gap = Eigen::VectorXd::Constant(x.rows(), std::numeric_limits<double>::infinity());
  for (const TriangleMesh& obstacle : obstacles)
    lower_to_distance(gap, points, x, obstacle.vertices, obstacle.triangles, range,
                      [](int, int) { return true; });
  return gap;
}

}  // namespace

const std::vector<FieldKind>& surface_fields() {
  static const std::vector<FieldKind> kinds = {
      {"mean_curvature", "mean curvature", "1/m", "diverging",
       "mean curvature; beyond the ends the end colours"},
      {"stretch", "largest stretch", "1", "sequential",
       "largest principal stretch of the triangles around; 1 is unstretched"},
      {"gap", "contact gap", "m", "near",
       "distance to an obstacle or another part of the cloth; farther away in cloth colour"},
      {"contact_pressure", "contact force", "Pa", "force",
       "force of contact on a vertex over its area; without one in cloth colour; known for the ends of "
       "levels"}};
  return kinds;
}

Eigen::VectorXd obstacle_distance(const Positions& x, const std::vector<TriangleMesh>& obstacles,
                                  double range) {
  Eigen::VectorXd gap = nearest_obstacle(tree_of(x), x, obstacles, range);
  for (double& g : gap) g = g <= range ? g : nan;
  return gap;
}

Eigen::VectorXd contact_gap(const Level& level, const Positions& x,
                            const std::vector<TriangleMesh>& obstacles, double range) {
  const BoxTree points = tree_of(x);
  Eigen::VectorXd gap = nearest_obstacle(points, x, obstacles, range);
  // A vertex's neighbourhood along the cloth is always near and is no contact.
  const Positions& rest = level.rest.vertices;
  const Triangles& triangles = level.rest.triangles;
  lower_to_distance(gap, points, x, x, triangles, range, [&](int i, int t) {
    for (int k = 0; k < 3; ++k)
      if ((rest.row(triangles(t, k)) - rest.row(i)).norm() < 3 * range) return false;
    return true;
  });
  for (double& g : gap) g = g <= range ? g : nan;
  return gap;
}

void add_contact_pressure(SurfaceFields& fields, const Eigen::VectorXd& pressure) {
  if (pressure.size() > 0) fields.emplace("contact_pressure", (pressure.array() > 0).select(pressure, nan));
}

std::pair<double, double> field_range(const FieldKind& kind,
                                      const std::vector<const Eigen::VectorXd*>& values, double gap_range) {
  const std::string& map = kind.map;
  if (map == "near") return {0, gap_range};
  if (map == "diverging") {
    const double end = magnitude_quantile(values, quantile);
    return {-std::max(end, 1e-6), std::max(end, 1e-6)};
  }
  if (map == "force") return {0, magnitude_quantile(values, quantile)};
  // Stretch begins at 1; the largest matters, so none is cut off.
  return {1, std::max(1.001, magnitude_quantile(values, 1))};
}

}  // namespace drape
