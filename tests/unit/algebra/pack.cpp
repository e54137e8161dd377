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

TEMPLATE_TEST_CASE_SIG("Pack: log is that of std to 1 ulp", "", ((int W), W), 2, 4, 8) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    Pack<W> a;
    for (int lane = 0; lane < W; ++lane) {
      const double all_sizes = std::exp2(1022 * u(random)),
                   near_one = 1 + u(random) * std::exp2(-(i % 40) - 1);
      a.v[lane] = i % 2 ? all_sizes : near_one;
    }
    const Pack<W> b = log(a);
    for (int lane = 0; lane < W; ++lane) worst = std::max(worst, ulps(b[lane], std::log(a[lane])));
  }
  CHECK(worst <= 1);
  CHECK(worst > 0);
  for (const double a : special) {
    INFO(a);
    CHECK(ulps(log(Pack<W>(a))[W - 1], std::log(a)) <= 1);
  }
}

TEMPLATE_TEST_CASE_SIG("Pack: atan2 is that of std to 2 ulp", "", ((int W), W), 2, 4, 8) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 1);
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    Pack<W> x, y;
    for (int lane = 0; lane < W; ++lane) {
      x.v[lane] = u(random) * std::exp2(i % 3 * 20 * u(random));
      y.v[lane] = u(random);
    }
    const Pack<W> a = atan2(y, x);
    for (int lane = 0; lane < W; ++lane) worst = std::max(worst, ulps(a[lane], std::atan2(y[lane], x[lane])));
  }
  CHECK(worst <= 2);
  CHECK(worst > 0);
  for (const double x : special)
    for (const double y : special) {
      if (std::isinf(x) && std::isinf(y)) continue;
      INFO(y << ", " << x);
      CHECK(ulps(atan2(Pack<W>(y), Pack<W>(x))[0], std::atan2(y, x)) <= 2);
    }
}

TEMPLATE_TEST_CASE_SIG("Pack: arithmetic, comparison and selection go lane by lane", "", ((int W), W), 2, 4,
                       8) {
  double values[3 * W];
  int index[W];
  for (int i = 0; i < 3 * W; ++i) values[i] = (i % 2 ? -1 : 1) * (0.3 + i * i);
  for (int lane = 0; lane < W; ++lane) index[lane] = 3 * (W - 1 - lane);
  Pack<W> a, b, c;
  gather_rows<W>(values, index, a, b, c);
  const auto less = a < b;
  for (int i = 0; i < W; ++i) {
    const double x = values[index[i]], y = values[index[i] + 1];
    REQUIRE(a[i] == x);
    REQUIRE(b[i] == y);
    REQUIRE(c[i] == values[index[i] + 2]);
    CHECK((a + b)[i] == x + y);
    CHECK((2.0 - a)[i] == 2.0 - x);
    CHECK((a * 3.0)[i] == x * 3.0);
    CHECK((a / b)[i] == x / y);
    CHECK((-a)[i] == -x);
    CHECK(abs(a)[i] == std::abs(x));
    CHECK(sqrt(abs(a))[i] == std::sqrt(std::abs(x)));
    CHECK(min(a, b)[i] == std::min(x, y));
    CHECK(max(a, b)[i] == std::max(x, y));
    CHECK(less[i] == (x < y));
    CHECK(select(less, a, 7.0)[i] == (x < y ? x : 7.0));
    CHECK(with_sign(abs(b), a)[i] == std::copysign(y, x));
    CHECK((a == b)[i] == false);
  }
  CHECK(any(less));
  CHECK(any(!less));
  CHECK_FALSE(any(less & !less));
  CHECK(std::signbit(Pack<W>(-0.0)[0]));
}
