#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/numerics/linear_algebra/pack_functions.h"

using namespace drape;

namespace {

/// Difference in units of the last place of `expected`; 0 where both are not a number.
double ulps(double found, double expected) {
  if (std::isnan(found) && std::isnan(expected)) return 0;
  if (found == expected) return std::signbit(found) == std::signbit(expected) ? 0 : 1e9;
  const double size = std::abs(expected);
  return std::abs(found - expected) / (std::nextafter(size, INFINITY) - size);
}

const std::vector<double> special = {0.0, -0.0, 1.0, -1.0, INFINITY, -INFINITY, NAN, 5e-324, 1e-310, 1e308};

}  // namespace

TEMPLATE_TEST_CASE_SIG("Pack: log is that of std to 1 ulp, atan2 to 2", "", ((int W), W), 2, 4, 8) {
  std::mt19937 random(1), other(2);
  std::uniform_real_distribution<double> u(-1, 1);
  double worst_log = 0, worst_atan2 = 0;
  for (int i = 0; i < 40000; ++i) {
    Pack<W> a, x, y;
    for (int lane = 0; lane < W; ++lane) {
      const double all_sizes = std::exp2(1022 * u(random)),
                   near_one = 1 + u(random) * std::exp2(-(i % 40) - 1);
      a.v[lane] = i % 2 ? all_sizes : near_one;
      x.v[lane] = u(other) * std::exp2(i % 3 * 20 * u(other));
      y.v[lane] = u(other);
    }
    const Pack<W> logarithm = log(a), angle = atan2(y, x);
    for (int lane = 0; lane < W; ++lane) {
      worst_log = std::max(worst_log, ulps(logarithm[lane], std::log(a[lane])));
      worst_atan2 = std::max(worst_atan2, ulps(angle[lane], std::atan2(y[lane], x[lane])));
    }
  }
  CHECK((worst_log > 0 && worst_log <= 1));
  CHECK((worst_atan2 > 0 && worst_atan2 <= 2));
  for (const double x : special) {
    INFO(x);
    CHECK(ulps(log(Pack<W>(x))[W - 1], std::log(x)) <= 1);
    for (const double y : special) {
      if (std::isinf(x) && std::isinf(y)) continue;
      INFO(y);
      CHECK(ulps(atan2(Pack<W>(y), Pack<W>(x))[0], std::atan2(y, x)) <= 2);
    }
  }
}
