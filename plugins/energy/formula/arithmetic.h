#pragma once

#include <cmath>
#include <limits>

#include "core/numerics/linear_algebra/pack_functions.h"
#include "plugins/energy/formula/term.h"

namespace drape::formula {

/// 1 where the mask holds, else 0; NaN where a or b is.
template <class T, class Mask>
T condition(const Mask& mask, const T& a, const T& b) {
  const T truth = select(mask, T(1.0), T(0.0));
  return select((a == a) & (b == b), truth, T(std::numeric_limits<double>::quiet_NaN()));
}

/// The operation of a term, other than an input, on double or Pack.
template <class T>
[[gnu::always_inline]] inline T evaluate(Op op, const T& a, const T& b, const T& c) {
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp, std::expm1,
      std::log, std::log1p, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
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
      return exp(a);
    case Op::expm1:
      return expm1(a);
    case Op::log:
      return log(a);
    case Op::log1p:
      return log1p(a);
    case Op::sin:
      return sin(a);
    case Op::cos:
      return cos(a);
    case Op::tan:
      return tan(a);
    case Op::asin:
      return asin(a);
    case Op::acos:
      return acos(a);
    case Op::atan:
      return atan(a);
    case Op::atan2:
      return atan2(a, b);
    case Op::sinh:
      return sinh(a);
    case Op::cosh:
      return cosh(a);
    case Op::tanh:
      return tanh(a);
    case Op::pow:
      return pow(a, b);
    case Op::abs:
      return abs(a);
    case Op::sign:
      return sign(a);
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
