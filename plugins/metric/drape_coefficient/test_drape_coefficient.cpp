
#include "tests/support/metric_check.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

Level specimen(int vertices) { return Level::of(0, disc(0.15, vertices)); }

MetricResult evaluate(const Level& level, const Positions& x) {
  static const auto metric = make_plugin_from<Metric>("{type: drape_coefficient, support_radius: 0.09}");
  return metric->evaluate({level, empty_model(), x});
}

/// The coefficient [%] of a shadow of this area over π [m²].
double percent(double shadow) { return 100 * (shadow - 0.09 * 0.09) / (0.15 * 0.15 - 0.09 * 0.09); }

}  // namespace

TEST_CASE("drape_coefficient: flat, hanging straight down, and turned back under itself") {
  const Level level = specimen(8000);
  const MetricResult flat = evaluate(level, level.rest.vertices);
  CHECK(value(flat, "drape_coefficient") == Approx(100).epsilon(1e-4));
  CHECK(value(flat, "folds") == 0);
  Positions hanging = level.rest.vertices, under = hanging;
  for (Eigen::Index i = 0; i < under.rows(); ++i) {
    const double r = under.row(i).norm();
    if (r > 0.09) hanging.row(i) = Eigen::RowVector3d(0, 0, 0.09 - r) + 0.09 / r * hanging.row(i);
    if (r > 0.12) under.row(i) = Eigen::RowVector3d(0, 0, -0.01) + (0.24 - r) / r * under.row(i);
  }
  CHECK(value(evaluate(level, hanging), "drape_coefficient") == Approx(0).margin(0.5));
  CHECK(value(evaluate(level, under), "drape_coefficient") ==
        Approx(percent(0.12 * 0.12)).margin(2));  // triangles cut the fold
}

TEST_CASE("drape_coefficient: folds of a known outline, wherever the cloth is") {
  const Level level = specimen(8000);
  for (const int folds : {3, 5, 8}) {
    INFO(folds);
    const double mean = 0.12, amplitude = 0.006;
    Positions x = level.rest.vertices;
    for (auto p : x.rowwise())  // its rest radius is 0.15
      p *= (mean + amplitude * std::cos(folds * std::atan2(p[1], p[0]) + 1)) / 0.15;
    x.rowwise() += Eigen::RowVector3d(0.3, -2, 0.7);
    const MetricResult result = evaluate(level, x);
    CHECK(value(result, "folds") == folds);
    CHECK(value(result, "fold_amplitude") == Approx(amplitude).epsilon(0.02));
    CHECK(value(result, "drape_coefficient") ==
          Approx(percent(mean * mean + amplitude * amplitude / 2)).epsilon(0.003));
  }
}

TEST_CASE("drape_coefficient: a support as large as the cloth is refused") {
  const Level level = Level::of(0, disc(0.05, 100));
  CHECK_THROWS_WITH(evaluate(level, level.rest.vertices), Catch::Contains("support_radius"));
}
