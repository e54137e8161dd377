#include <cmath>

#include "tests/support/metric_check.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

Level specimen(int vertices = 2000) { return Level::of(0, disc(0.15, vertices)); }

MetricResult evaluate(const Level& level, const Positions& x) {
  static const auto metric = make_plugin_from<Metric>("{type: drape_coefficient, support_radius: 0.09}");
  return metric->evaluate({level, empty_model(), x});
}

/// The cloth whose outline is at r(φ) for the rest radius 0.15, the rest in proportion.
template <class Radius>
Positions with_outline(const Level& level, const Radius& radius) {
  Positions x = level.rest.vertices;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double factor = radius(std::atan2(x(i, 1), x(i, 0))) / 0.15;
    x(i, 0) *= factor, x(i, 1) *= factor;
  }
  return x;
}

}  // namespace

TEST_CASE("drape_coefficient: a flat specimen has 100 %, and one that hangs straight down 0 %") {
  const Level level = specimen();
  const MetricResult flat = evaluate(level, level.rest.vertices);
  CHECK(value(flat, "drape_coefficient") == Approx(100).epsilon(1e-4));
  CHECK(value(flat, "folds") == 0);
  Positions hanging = level.rest.vertices;
  for (Eigen::Index i = 0; i < hanging.rows(); ++i) {
    const double r = hanging.row(i).norm();
    if (r <= 0.09) continue;
    hanging.row(i) *= 0.09 / r;
    hanging(i, 2) = 0.09 - r;
  }
  CHECK(value(evaluate(level, hanging), "drape_coefficient") == Approx(0).margin(0.5));
}

TEST_CASE("drape_coefficient: folds of a known outline, wherever the cloth is") {
  const Level level = specimen(8000);
  for (const int folds : {3, 5, 8}) {
    INFO(folds);
    const double mean = 0.12, amplitude = 0.006;
    Positions x =
        with_outline(level, [&](double angle) { return mean + amplitude * std::cos(folds * angle + 1); });
    x.rowwise() += Eigen::RowVector3d(0.3, -2, 0.7);
    const MetricResult result = evaluate(level, x);
    CHECK(value(result, "folds") == folds);
    CHECK(value(result, "fold_amplitude") == Approx(amplitude).epsilon(0.02));
    const double shadow = mean * mean + amplitude * amplitude / 2;
    CHECK(value(result, "drape_coefficient") ==
          Approx(100 * (shadow - 0.0081) / (0.0225 - 0.0081)).epsilon(0.003));
  }
}

TEST_CASE("drape_coefficient: what lies under the cloth casts no shadow of its own") {
  const Level level = specimen(8000);
  Positions x = level.rest.vertices;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (const double r = x.row(i).norm(); r > 0.12) {  // turned back under itself
      x.row(i) *= (0.24 - r) / r;
      x(i, 2) = -0.01;
    }
  const double shadow = 0.0144;
  CHECK(value(evaluate(level, x), "drape_coefficient") ==
        Approx(100 * (shadow - 0.0081) / (0.0225 - 0.0081)).margin(2));  // triangles cut the fold
}

TEST_CASE("drape_coefficient: a support as large as the cloth is refused") {
  const Level level = Level::of(0, disc(0.05, 100));
  CHECK_THROWS_WITH(evaluate(level, level.rest.vertices), Catch::Contains("support_radius"));
}
