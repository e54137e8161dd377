#pragma once

#include <algorithm>
#include <concepts>
#include <type_traits>

#include "core/numerics/linear_algebra/pack.h"

namespace drape {

/// A number that depends on N variables, with its first and second derivatives: exact, by the rules of
/// calculus. T is double, a Pack, or anything with their arithmetic, such as the terms of a formula that is
/// being compiled. The value has the same bits for any N. core/numerics/elements/jet_functions.h has sqrt,
/// log and so on.
template <int N, class T>
struct Jet {
  static constexpr int variables = N, pairs = N * (N + 1) / 2;
  static constexpr int index(int i, int j) { return i <= j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j; }

  T value;
  T first[N];
  T second[pairs];  ///< upper triangle, column by column: index(i, j)

  Jet() = default;
  /// A constant.
  Jet(const T& constant) : value(constant) {
    for (T& d : first) d = T(0.0);
    for (T& d : second) d = T(0.0);
  }
  Jet(double constant) requires(!std::is_same_v<T, double>) : Jet(T(constant)) {}
  /// Variable i.
  static Jet variable(const T& value, int i) {
    Jet x(value);
    x.first[i] = T(1.0);
    return x;
  }
  const T& second_by(int i, int j) const { return second[index(i, j)]; }

  friend Jet operator+(const Jet& a, const Jet& b) {
    return combined(a, b, a.value + b.value, [](const T& x, const T& y) { return x + y; });
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return combined(a, b, a.value - b.value, [](const T& x, const T& y) { return x - y; });
  }
  friend Jet operator-(const Jet& a) {
    return combined(a, a, -a.value, [](const T& x, const T&) { return -x; });
  }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet r;
    r.value = rounded(a.value * b.value);
    for (int i = 0; i < N; ++i) r.first[i] = a.value * b.first[i] + a.first[i] * b.value;
    for (int j = 0; j < N; ++j)
      for (int i = 0; i <= j; ++i) {
        const int k = index(i, j);
        r.second[k] = (a.value * b.second[k] + a.second[k] * b.value) +
                      (a.first[i] * b.first[j] + a.first[j] * b.first[i]);
      }
    return r;
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    Jet r;
    r.value = a.value / b.value;
    const T inverse = T(1.0) / b.value;
    for (int i = 0; i < N; ++i) r.first[i] = (a.first[i] - r.value * b.first[i]) * inverse;
    for (int j = 0; j < N; ++j)
      for (int i = 0; i <= j; ++i) {
        const int k = index(i, j);
        r.second[k] =
            ((a.second[k] - r.value * b.second[k]) - (r.first[i] * b.first[j] + r.first[j] * b.first[i])) *
            inverse;
      }
    return r;
  }

  // With a number that depends on no variable: the same without the terms of 0.
  template <std::convertible_to<T> S>
  friend Jet operator+(const Jet& a, const S& b) {
    Jet r = a;
    r.value = a.value + b;
    return r;
  }
  template <std::convertible_to<T> S>
  friend Jet operator+(const S& a, const Jet& b) {
    return b + a;
  }
  template <std::convertible_to<T> S>
  friend Jet operator-(const Jet& a, const S& b) {
    return a + -b;
  }
  template <std::convertible_to<T> S>
  friend Jet operator-(const S& a, const Jet& b) {
    return -b + a;
  }
  template <std::convertible_to<T> S>
  friend Jet operator*(const S& a, const Jet& b) {
    const T factor(a);
    return combined(b, b, rounded(factor * b.value), [&](const T& x, const T&) { return factor * x; });
  }
  template <std::convertible_to<T> S>
  friend Jet operator*(const Jet& a, const S& b) {
    return b * a;
  }
  template <std::convertible_to<T> S>
  friend Jet operator/(const Jet& a, const S& b) {
    return (T(1.0) / T(b)) * a;
  }
  template <std::convertible_to<T> S>
  friend Jet operator/(const S& a, const Jet& b) {
    const T value = T(a) / b.value, first = -value / b.value;
    return chain(b, value, first, -2.0 * first / b.value);
  }

  // Comparisons are those of the values; a number is compared as a constant.
  friend auto operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
  friend auto operator<=(const Jet& a, const Jet& b) { return a.value <= b.value; }
  friend auto operator>(const Jet& a, const Jet& b) { return a.value > b.value; }
  friend auto operator>=(const Jet& a, const Jet& b) { return a.value >= b.value; }
  /// a where the condition holds, else b, with its derivatives.
  template <class Mask>
  friend Jet select(const Mask& condition, const Jet& a, const Jet& b) {
    const auto pick = [&](const T& x, const T& y) { return select(condition, x, y); };
    return combined(a, b, pick(a.value, b.value), pick);
  }
  /// Derivatives are those of the argument that is chosen, the first at a tie.
  friend Jet min(const Jet& a, const Jet& b) {
    using std::min;
    Jet r = select(b.value < a.value, b, a);
    r.value = min(a.value, b.value);
    return r;
  }
  friend Jet max(const Jet& a, const Jet& b) {
    using std::max;
    Jet r = select(a.value < b.value, b, a);
    r.value = max(a.value, b.value);
    return r;
  }

  /// f(a) from f, f' and f'' at a.value.
  friend Jet chain(const Jet& a, const T& f, const T& f1, const T& f2) {
    Jet r;
    r.value = f;
    for (int i = 0; i < N; ++i) r.first[i] = f1 * a.first[i];
    for (int j = 0; j < N; ++j)
      for (int i = 0; i <= j; ++i)
        r.second[index(i, j)] = f1 * a.second[index(i, j)] + f2 * (a.first[i] * a.first[j]);
    return r;
  }

  /// op(x, y) of the derivatives of a and b, which is linear, and the value given.
  template <class Op>
  static Jet combined(const Jet& a, const Jet& b, const T& value, const Op& op) {
    Jet r;
    r.value = value;
    for (int i = 0; i < N; ++i) r.first[i] = op(a.first[i], b.first[i]);
    for (int k = 0; k < pairs; ++k) r.second[k] = op(a.second[k], b.second[k]);
    return r;
  }
};

}  // namespace drape
