#pragma once

#include <bit>
#include <cmath>
#include <cstdlib>

#include "core/kernel/elements/jet.h"
#include "core/kernel/linear_algebra/pack_functions.h"

// Functions of jets. Each finds that of T by argument-dependent lookup, or the standard library's for double.

namespace drape {

template <int N, class T>
Jet<N, T> sqrt(const Jet<N, T>& a) {
  using std::sqrt;
  const T f = sqrt(a.value), f1 = 0.5 / f;
  return chain(a, f, f1, -0.5 * (f1 / a.value));
}
template <int N, class T>
Jet<N, T> log(const Jet<N, T>& a) {
  using std::log;
  const T inverse = 1.0 / a.value;
  return chain(a, log(a.value), inverse, -(inverse * inverse));
}
template <int N, class T>
Jet<N, T> log1p(const Jet<N, T>& a) {
  using std::log1p;
  const T inverse = 1.0 / (1.0 + a.value);
  return chain(a, log1p(a.value), inverse, -(inverse * inverse));
}
template <int N, class T>
Jet<N, T> exp(const Jet<N, T>& a) {
  using std::exp;
  const T f = exp(a.value);
  return chain(a, f, f, f);
}
template <int N, class T>
Jet<N, T> expm1(const Jet<N, T>& a) {
  using std::exp, std::expm1;
  const T f1 = exp(a.value);
  return chain(a, expm1(a.value), f1, f1);
}
template <int N, class T>
Jet<N, T> sin(const Jet<N, T>& a) {
  using std::cos, std::sin;
  const T f = sin(a.value);
  return chain(a, f, cos(a.value), -f);
}
template <int N, class T>
Jet<N, T> cos(const Jet<N, T>& a) {
  using std::cos, std::sin;
  const T f = cos(a.value);
  return chain(a, f, -sin(a.value), -f);
}
template <int N, class T>
Jet<N, T> tan(const Jet<N, T>& a) {
  using std::tan;
  const T f = tan(a.value), slope = 1.0 + f * f;
  return chain(a, f, slope, 2.0 * (f * slope));
}
template <int N, class T>
Jet<N, T> asin(const Jet<N, T>& a) {
  using std::asin, std::sqrt;
  const T slope = 1.0 / sqrt(1.0 - a.value * a.value);
  return chain(a, asin(a.value), slope, a.value * (slope * (slope * slope)));
}
template <int N, class T>
Jet<N, T> acos(const Jet<N, T>& a) {
  using std::acos, std::sqrt;
  const T slope = -1.0 / sqrt(1.0 - a.value * a.value);
  return chain(a, acos(a.value), slope, a.value * (slope * (slope * slope)));
}
template <int N, class T>
Jet<N, T> atan(const Jet<N, T>& a) {
  using std::atan;
  const T slope = 1.0 / (1.0 + a.value * a.value);
  return chain(a, atan(a.value), slope, -2.0 * (a.value * (slope * slope)));
}
template <int N, class T>
Jet<N, T> sinh(const Jet<N, T>& a) {
  using std::cosh, std::sinh;
  const T f = sinh(a.value);
  return chain(a, f, cosh(a.value), f);
}
template <int N, class T>
Jet<N, T> cosh(const Jet<N, T>& a) {
  using std::cosh, std::sinh;
  const T f = cosh(a.value);
  return chain(a, f, sinh(a.value), f);
}
template <int N, class T>
Jet<N, T> tanh(const Jet<N, T>& a) {
  using std::tanh;
  const T f = tanh(a.value), slope = 1.0 + -1.0 * (f * f);
  return chain(a, f, slope, -2.0 * (f * slope));
}

/// Has slope 0 at 0.
template <int N, class T>
Jet<N, T> abs(const Jet<N, T>& a) {
  using std::abs;
  return chain(a, abs(a.value), sign(a.value), T(0.0));
}
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
