#include "core/app/view/surface_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/collision_detection/closest.h"
#include "core/numerics/collision_detection/surface_search.h"
#include "core/numerics/elements/green_strain.h"

namespace drape {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double quantile = 0.98;    // of the values inside the colours' range
constexpr double ease_range = 0.06;  // [m]

/// Lowers known[i], NaN at first, to the distance of each point i to every triangle of a surface within
/// `range` that `counts(i, t)`.
template <class Counts>
void lower_to_distance(Eigen::VectorXd& known, const Positions& x, const TriangleMesh& surface, double range,
                       const Counts& counts) {
  const SurfaceSearch search(surface);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Eigen::Vector3d p = x.row(i);
    search.visit_near(p, range, [&](int t) {
      if (!counts(i, t)) return;
      const Eigen::Matrix3d c = surface.vertices(surface.triangles.row(t), Eigen::all).transpose();
      const Eigen::Vector4d w = closest_point_triangle(p, c.col(0), c.col(1), c.col(2)).c;
      const double distance = (w[0] * p + w[1] * c.col(0) + w[2] * c.col(1) + w[3] * c.col(2)).norm();
      if (distance <= range) known[i] = std::fmin(known[i], distance);
    });
  }
}

/// n distances to the nearest triangle of the obstacles [m]; NaN beyond `range`.
Eigen::VectorXd obstacle_distance(const Positions& x, const std::vector<TriangleMesh>& obstacles,
                                  double range) {
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(x.rows(), nan);
  for (const TriangleMesh& obstacle : obstacles)
    lower_to_distance(distance, x, obstacle, range, [](Eigen::Index, int) { return true; });
  return distance;
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

}  // namespace

std::vector<FieldKind> field_kinds(bool worn) {
  std::vector<FieldKind> kinds = {
      {"mean_curvature", "mean curvature", "1/m", "diverging",
       "mean curvature; beyond the ends the end colours"},
      {"stretch", "largest stretch", "1", "sequential",
       "largest principal stretch of the triangles around; 1 is unstretched"},
      {"gap", "contact gap", "m", "near",
       "distance to an obstacle or another part of the cloth; farther away in cloth colour"},
      {"contact_pressure", "contact force", "Pa", "force",
       "force of contact on a vertex over its area as it is stretched; without one in cloth colour; known "
       "for the ends of levels"},
      {"stretch_warp", "stretch along warp", "%", "diverging",
       "of the triangles around, on both sides of a seam; 0 is unstretched"},
      {"stretch_weft", "stretch along weft", "%", "diverging",
       "of the triangles around, on both sides of a seam; 0 is unstretched"},
      {"ease", "ease", "mm", "force", "distance to the body; beyond 60 mm in cloth colour"}};
  if (!worn) kinds.resize(kinds.size() - 3);  // without those of garments
  return kinds;
}

Eigen::VectorXd contact_gap(const Level& level, const Positions& x,
                            const std::vector<TriangleMesh>& obstacles, double range) {
  Eigen::VectorXd gap = obstacle_distance(x, obstacles, range);
  // A vertex's neighbourhood along the cloth is always near and is not a contact.
  const Positions& rest = level.rest.vertices;
  const Triangles& triangles = level.rest.triangles;
  lower_to_distance(gap, x, {x, triangles}, range, [&](Eigen::Index i, int t) {
    for (int k = 0; k < 3; ++k)
      if ((rest.row(triangles(t, k)) - rest.row(i)).norm() < 3 * range) return false;
    return true;
  });
  return gap;
}

std::pair<double, double> field_range(const FieldKind& kind,
                                      const std::vector<const Eigen::VectorXd*>& values, double gap_range) {
  if (kind.map == "near") return {0, gap_range};
  if (kind.map == "diverging") {
    const double end = magnitude_quantile(values, quantile);
    return {-std::max(end, 1e-6), std::max(end, 1e-6)};
  }
  if (kind.map == "force") return {0, magnitude_quantile(values, quantile)};
  // Stretch begins at 1; the largest matters, so none is cut off.
  return {1, std::max(1.001, magnitude_quantile(values, 1))};
}

Eigen::MatrixX2d stretch_percent(const Level& level, const Positions& x) {
  const std::vector<MaterialTriangle> rest = material_triangles(level);
  Eigen::MatrixX2d stretch(level.triangle_count(), 2);
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const Eigen::RowVector3d e1 = x.row(v[1]) - x.row(v[0]), e2 = x.row(v[2]) - x.row(v[0]);
    const MaterialTriangle& m = rest[t];
    stretch.row(t) << (m[0] * e1 + m[1] * e2).norm(), (m[2] * e1 + m[3] * e2).norm();
  }
  return 100 * (stretch.array() - 1);
}

VertexFields garment_fields_at(const Level& level, const Positions& x,
                               const std::vector<TriangleMesh>& obstacles) {
  const std::vector<MaterialTriangle> rest = material_triangles(level);
  const Eigen::MatrixX2d stretch = stretch_percent(level, x);
  Eigen::MatrixX2d around = Eigen::MatrixX2d::Zero(x.rows(), 2);
  Eigen::VectorXd area = Eigen::VectorXd::Zero(x.rows());
  for (int t = 0; t < level.triangle_count(); ++t)
    for (const int v : level.rest.triangles.row(t)) {
      around.row(v) += rest[t][4] * stretch.row(t);
      area[v] += rest[t][4];
    }
  return {{"stretch_warp", around.col(0).cwiseQuotient(area)},
          {"stretch_weft", around.col(1).cwiseQuotient(area)},
          {"ease", 1000 * obstacle_distance(x, obstacles, ease_range)}};
}

}  // namespace drape
