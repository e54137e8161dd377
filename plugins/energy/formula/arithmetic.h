#pragma once

#include <cmath>
#include <limits>

#include "core/kernel/linear_algebra/pack.h"
#include "plugins/energy/formula/term.h"

namespace drape::formula {

/// A function of the standard library in each lane.
template <class Function>
double in_lanes(double a, const Function& f) {
  return f(a);
}
template <int W, class Function>
Pack<W> in_lanes(Pack<W> a, const Function& f) {
  for (int i = 0; i < W; ++i) a.v[i] = f(a.v[i]);
  return a;
}
template <class Function>
double in_lanes(double a, double b, const Function& f) {
  return f(a, b);
}
template <int W, class Function>
Pack<W> in_lanes(Pack<W> a, const Pack<W>& b, const Function& f) {
  for (int i = 0; i < W; ++i) a.v[i] = f(a.v[i], b.v[i]);
  return a;
}

/// 1 where the mask holds, else 0; NaN where a or b is.
template <class T, class Mask>
T condition(const Mask& mask, const T& a, const T& b) {
  const T truth = select(mask, T(1.0), T(0.0));
  return select((a == a) & (b == b), truth, T(std::numeric_limits<double>::quiet_NaN()));
}

/// The operation of a term, other than an input, on double or Pack.
template <class T>
[[gnu::always_inline]] inline T evaluate(Op op, const T& a, const T& b, const T& c) {
  using std::abs, std::atan2, std::log, std::sqrt;
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::negate:
      return -a;
    case Op::square_root:
      return sqrt(a);
    case Op::exp:
      return in_lanes(a, [](double x) { return std::exp(x); });
    case Op::expm1:
      return in_lanes(a, [](double x) { return std::expm1(x); });
    case Op::log:
      return log(a);
    case Op::log1p:
      return in_lanes(a, [](double x) { return std::log1p(x); });
    case Op::sin:
      return in_lanes(a, [](double x) { return std::sin(x); });
    case Op::cos:
      return in_lanes(a, [](double x) { return std::cos(x); });
    case Op::tan:
      return in_lanes(a, [](double x) { return std::tan(x); });
    case Op::asin:
      return in_lanes(a, [](double x) { return std::asin(x); });
    case Op::acos:
      return in_lanes(a, [](double x) { return std::acos(x); });
    case Op::atan:
      return in_lanes(a, [](double x) { return std::atan(x); });
    case Op::atan2:
      return atan2(a, b);
    case Op::sinh:
      return in_lanes(a, [](double x) { return std::sinh(x); });
    case Op::cosh:
      return in_lanes(a, [](double x) { return std::cosh(x); });
    case Op::tanh:
      return in_lanes(a, [](double x) { return std::tanh(x); });
    case Op::pow:
      return in_lanes(a, b, [](double x, double y) { return std::pow(x, y); });
    case Op::abs:
      return abs(a);
    case Op::sign: {
      const T up = select(a > 0.0, T(1.0), a);  // zero and NaN stay
      return select(a < 0.0, T(-1.0), up);
    }
    case Op::min: {
      const T least = select(b < a, b, a);
      return select(b == b, least, b);
    }
    case Op::max: {
      const T largest = select(b > a, b, a);
      return select(b == b, largest, b);
    }
    case Op::less:
      return condition(a < b, a, b);
    case Op::less_equal:
      return condition(a <= b, a, b);
    case Op::equal:
      return condition(a == b, a, b);
    case Op::both:
      return a * b;
    case Op::either:
      return a + b - a * b;
    case Op::negated:
      return 1.0 - a;
    case Op::multiply_add:
      return a * b + c;
    case Op::choose: {
      const T chosen = select(a == 0.0, c, b);
      return select(a == a, chosen, a);
    }
    default:
      break;
  }
  return T(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace drape::formula
