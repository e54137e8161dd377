#include <limits>

#include "core/numerics/collision_detection/closest.h"
#include "tests/support/kernel_check.h"
#include "tests/support/metric_check.h"
#include "tests/support/registry.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

MetricResult evaluate(const Level& level, const Positions& x, const Positions& other) {
  static const auto metric = make_plugin_from<Metric>("distance");
  return metric->evaluate({level, empty_model(), x, &other});
}

/// Bumpy, folded enough that the nearest triangle is not the corresponding one.
Positions crumpled(const Level& level, double phase) {
  Positions x = level.rest.vertices;
  for (auto p : x.rowwise()) {
    const double u = p[0], v = p[1];
    p << 0.5 * std::sin(4 * u + phase), v + 0.1 * std::cos(9 * u), 0.3 * std::sin(7 * v + 3 * u + phase);
  }
  return x;
}

}  // namespace

TEST_CASE("the Hausdorff distance is what looking at every triangle finds") {
  const auto check = [](const Level& level, const Positions& x, const Positions& other) {
    double farthest = 0;
    for (const auto& [from, to] : {std::pair(&x, &other), std::pair(&other, &x)})
      for (Eigen::Index i = 0; i < from->rows(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int t = 0; t < level.triangle_count(); ++t) {
          const auto v = level.rest.triangles.row(t);
          const Vector3d corners[4] = {from->row(i), to->row(v[0]), to->row(v[1]), to->row(v[2])};
          const Closest c = closest_point_triangle(corners[0], corners[1], corners[2], corners[3]);
          Vector3d way = Vector3d::Zero();
          for (int k = 0; k < 4; ++k) way += c.c[k] * corners[k];
          nearest = std::min(nearest, way.norm());
        }
        farthest = std::max(farthest, nearest);
      }
    CHECK(value(evaluate(level, x, other), "distance_hausdorff") ==
          Approx(farthest / std::sqrt(2.0)).epsilon(1e-12));
  };
  for (int trial = 0; trial < 10; ++trial)
    check(square(7), crumpled(square(7), 0.3 * trial), crumpled(square(7), 0.3 * trial + 0.4));
  // Two triangles alone, so that few errors would hide behind another vertex; one state is, but for less and
  // less, on a line in no axis' direction.
  const Vector3d line = Vector3d(1, -2, 0.7).normalized();
  for (int trial = 0; trial < 400; ++trial) {
    const double left = trial < 100 ? 1 : trial < 200 ? 1e-7 : trial < 300 ? 1e-14 : 0;
    const Eigen::VectorXd numbers = normal_numbers(24, trial);
    const Positions x = Eigen::Map<const Positions>(numbers.data(), 4, 3);
    const Positions other = Eigen::Map<const Positions>(numbers.data() + 12, 4, 3) *
                            (left * Eigen::Matrix3d::Identity() + (1 - left) * line * line.transpose());
    check(square(1), x, other);
  }
}

TEST_CASE("a lift across the surface counts in every distance, a slide along it only at the border") {
  const Level level = square(10);
  const double diagonal = std::sqrt(2.0);
  const Positions& x = level.rest.vertices;
  const Positions lifted = x.rowwise() + Eigen::RowVector3d(0, 0, 0.25);
  for (const char* name : {"distance_rms", "distance_max", "distance_hausdorff"})
    CHECK(value(evaluate(level, x, lifted), name) == Approx(0.25 / diagonal));

  // Each row slides by at most 0.04 within the square, nothing at the border: the surface stays where it is.
  Positions slid = x;
  const Eigen::ArrayXd slide = 0.16 * x.col(0).array() * (1 - x.col(0).array());
  slid.col(0) += slide.matrix();
  const MetricResult result = evaluate(level, x, slid);
  CHECK(value(result, "distance_max") == Approx(0.04 / diagonal));
  CHECK(value(result, "distance_hausdorff") == Approx(0).margin(1e-12));
  CHECK(value(result, "distance_rms") ==
        Approx(std::sqrt(level.vertex_area.dot(slide.square().matrix())) / diagonal));
}

TEST_CASE("distances are relative to the rest diagonal and ordered") {
  const Level level = square(16), large = Level::of(0, {10 * level.rest.vertices, level.rest.triangles});
  const Positions x = crumpled(level, 0), other = crumpled(level, 0.4);
  const MetricResult small = evaluate(level, x, other), scaled = evaluate(large, 10 * x, 10 * other);
  CHECK(value(small, "distance_rms") > 0.01);
  CHECK(value(small, "distance_hausdorff") > 0.01);
  for (const char* name : {"distance_rms", "distance_hausdorff"})
    CHECK(value(small, name) < value(small, "distance_max"));
  for (const MetricValue& v : small.values) CHECK(value(scaled, v.name) == Approx(v.value).epsilon(1e-10));
}
