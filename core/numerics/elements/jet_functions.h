#pragma once

#include <bit>
#include <cmath>
#include <cstdlib>

#include "core/numerics/elements/jet.h"
#include "core/numerics/linear_algebra/pack_functions.h"

// Functions of jets. Each finds that of T by argument-dependent lookup, or the standard library's for double.

namespace drape {

/// A function of x by its derivatives: f1 may use f, the value, and f2 both.
#define DRAPE_JET_FUNCTION(name, f1_at_x, f2_at_x)                                  \
  template <int N, class T>                                                         \
  Jet<N, T> name(const Jet<N, T>& a) {                                              \
    using std::name, std::cos, std::cosh, std::exp, std::sin, std::sinh, std::sqrt; \
    [[maybe_unused]] const T& x = a.value;                                          \
    const T f = name(x), f1 = f1_at_x;                                              \
    return chain(a, f, f1, f2_at_x);                                                \
  }
// It takes these products for pointers.
// clang-format off
DRAPE_JET_FUNCTION(sqrt, 0.5 / f, -0.5 * (f1 / x))
DRAPE_JET_FUNCTION(log, 1.0 / x, -(f1 * f1))
DRAPE_JET_FUNCTION(log1p, 1.0 / (1.0 + x), -(f1 * f1))
DRAPE_JET_FUNCTION(exp, f, f)
DRAPE_JET_FUNCTION(expm1, exp(x), f1)
DRAPE_JET_FUNCTION(sin, cos(x), -f)
DRAPE_JET_FUNCTION(cos, -sin(x), -f)
DRAPE_JET_FUNCTION(tan, 1.0 + f * f, 2.0 * (f * f1))
DRAPE_JET_FUNCTION(asin, 1.0 / sqrt(1.0 - x * x), x * (f1 * (f1 * f1)))
DRAPE_JET_FUNCTION(acos, -1.0 / sqrt(1.0 - x * x), x * (f1 * (f1 * f1)))
DRAPE_JET_FUNCTION(atan, 1.0 / (1.0 + x * x), -2.0 * (x * (f1 * f1)))
DRAPE_JET_FUNCTION(sinh, cosh(x), f)
DRAPE_JET_FUNCTION(cosh, sinh(x), f)
DRAPE_JET_FUNCTION(tanh, 1.0 - f * f, -2.0 * (f * f1))
DRAPE_JET_FUNCTION(abs, sign(x), T(0.0))  // slope 0 at 0
// clang-format on
#undef DRAPE_JET_FUNCTION

template <int N, class T>
Jet<N, T> sign(const Jet<N, T>& a) {
  return Jet<N, T>(sign(a.value));
}

/// Angle of (x, y), by both.
template <int N, class T>
Jet<N, T> atan2(const Jet<N, T>& y, const Jet<N, T>& x) {
  using std::atan2;
  const T square = x.value * x.value + y.value * y.value;
  const T by_y = x.value / square, by_x = -(y.value / square);
  const T yy = 2.0 * (by_y * by_x), yx = by_x * by_x - by_y * by_y;  // xx = -yy
  Jet<N, T> r;
  r.value = atan2(y.value, x.value);
  for (int i = 0; i < N; ++i) r.first[i] = by_y * y.first[i] + by_x * x.first[i];
  for (int j = 0; j < N; ++j)
    for (int i = 0; i <= j; ++i) {
      const int k = r.index(i, j);
      const T curved = yy * (y.first[i] * y.first[j] - x.first[i] * x.first[j]) +
                       yx * (y.first[i] * x.first[j] + x.first[i] * y.first[j]);
      r.second[k] = by_y * y.second[k] + by_x * x.second[k] + curved;
    }
  return r;
}

/// x^n by multiplications.
template <class T>
T integer_power(const T& x, int n) {
  const auto m = static_cast<unsigned>(std::abs(n));
  if (m == 0) return 1.0;
  T power = x;
  for (int bit = std::bit_width(m) - 2; bit >= 0; --bit) {
    power = power * power;
    if ((m >> bit) & 1U) power = power * x;
  }
  return n < 0 ? T(1.0 / power) : power;
}
/// x^y of a number that needs no pow() for whole exponents and roots.
template <class T>
T constant_power(const T& x, double y) {
  using std::pow, std::sqrt;
  if (y == std::round(y) && std::abs(y) <= 32) return integer_power(x, static_cast<int>(y));
  if (y == 0.5) return sqrt(x);
  if (y == -0.5) return 1.0 / sqrt(x);
  return pow(x, T(y));
}
template <int N, class T>
Jet<N, T> pow(const Jet<N, T>& x, double n) {
  return chain(x, constant_power(x.value, n), n == 0 ? T(0.0) : n * constant_power(x.value, n - 1),
               n == 0 || n == 1 ? T(0.0) : (n * (n - 1)) * constant_power(x.value, n - 2));
}
template <int N, class T>
Jet<N, T> pow(const Jet<N, T>& x, const Jet<N, T>& y) {
  using std::pow;
  const T f = pow(x.value, y.value);
  return chain(y * log(x), f, f, f);
}

template <class T>
T square(const T& x) {
  return x * x;
}

}  // namespace drape
