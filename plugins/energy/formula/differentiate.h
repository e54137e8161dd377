#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "core/kernel/elements/jet.h"
#include "plugins/energy/formula/syntax.h"
#include "plugins/energy/formula/term.h"

namespace drape::formula {

/// Functions of formulas on jets of terms. Derivatives of min, max and if are those of the argument that is
/// chosen; abs and sign have derivative 0 at 0.
template <int N>
struct Differentiate {
  using J = Jet<N, Term>;

  static bool is_literal(const J& a) {
    bool literal = !a.value.graph;
    for (const Term& t : a.first) literal = literal && t.is(0);
    for (const Term& t : a.second) literal = literal && t.is(0);
    return literal;
  }

  static J square_root(const J& a) {
    const Term f = apply(Op::square_root, a.value), f1 = 0.5 / f;
    return chain(a, f, f1, -0.5 * (f1 / a.value));
  }
  static J logarithm(const J& a) {
    const Term inverse = 1.0 / a.value;
    return chain(a, apply(Op::log, a.value), inverse, -(inverse * inverse));
  }

  static Term integer_power(const Term& x, int n) {
    if (n < 0) return 1.0 / integer_power(x, -n);
    if (n == 0) return 1.0;
    const Term half = integer_power(x, n / 2);
    return n % 2 == 0 ? half * half : n == 1 ? x : (half * half) * x;
  }
  static Term power(const Term& x, double y) {
    if (y == std::round(y) && std::abs(y) <= 32) return integer_power(x, static_cast<int>(y));
    if (y == 0.5) return apply(Op::square_root, x);
    if (y == -0.5) return 1.0 / apply(Op::square_root, x);
    return apply(Op::pow, x, y);
  }
  static J power(const J& x, const J& y) {
    if (is_literal(y)) {
      const double n = y.value.literal;
      return chain(x, power(x.value, n), n == 0 ? Term(0.0) : n * power(x.value, n - 1),
                   n == 0 || n == 1 ? Term(0.0) : (n * (n - 1)) * power(x.value, n - 2));
    }
    const Term f = apply(Op::pow, x.value, y.value);
    return chain(y * logarithm(x), f, f, f);
  }

  static J angle(const J& y, const J& x) {
    const Term square = x.value * x.value + y.value * y.value;
    const Term by_y = x.value / square, by_x = -(y.value / square);
    const Term yy = 2.0 * (by_y * by_x), yx = by_x * by_x - by_y * by_y;  // xx = -yy
    J r;
    r.value = apply(Op::atan2, y.value, x.value);
    for (int i = 0; i < N; ++i) r.first[i] = by_y * y.first[i] + by_x * x.first[i];
    for (int j = 0; j < N; ++j)
      for (int i = 0; i <= j; ++i) {
        const int k = J::index(i, j);
        const Term curved = yy * (y.first[i] * y.first[j] - x.first[i] * x.first[j]) +
                            yx * (y.first[i] * x.first[j] + x.first[i] * y.first[j]);
        r.second[k] = by_y * y.second[k] + by_x * x.second[k] + curved;
      }
    return r;
  }

  /// a where the condition is not 0, else b.
  static J choose(const Term& condition, const J& a, const J& b) {
    const auto pick = [&](const Term& x, const Term& y) { return apply(Op::choose, condition, x, y); };
    return J::combined(a, b, pick(a.value, b.value), pick);
  }
  static J extreme(Op op, const J& a, const J& b) {
    const Term second = op == Op::min ? apply(Op::less, b.value, a.value) : apply(Op::less, a.value, b.value);
    J r = choose(second, b, a);
    r.value = apply(op, a.value, b.value);
    return r;
  }

  static J of_one(const std::string& word, const J& a) {
    const Term& x = a.value;
    const auto f = [&](Op op) { return apply(op, x); };
    if (word == "-") return -a;
    if (word == "not") return J(f(Op::negated));
    if (word == "sqrt") return square_root(a);
    if (word == "log") return logarithm(a);
    if (word == "sign") return J(f(Op::sign));
    if (word == "abs") return chain(a, f(Op::abs), f(Op::sign), 0.0);
    if (word == "exp") return chain(a, f(Op::exp), f(Op::exp), f(Op::exp));
    if (word == "expm1") return chain(a, f(Op::expm1), f(Op::exp), f(Op::exp));
    if (word == "sin") return chain(a, f(Op::sin), f(Op::cos), -f(Op::sin));
    if (word == "cos") return chain(a, f(Op::cos), -f(Op::sin), -f(Op::cos));
    if (word == "sinh") return chain(a, f(Op::sinh), f(Op::cosh), f(Op::sinh));
    if (word == "cosh") return chain(a, f(Op::cosh), f(Op::sinh), f(Op::cosh));
    if (word == "log1p") {
      const Term inverse = 1.0 / (1.0 + x);
      return chain(a, f(Op::log1p), inverse, -(inverse * inverse));
    }
    if (word == "tan" || word == "tanh") {
      const double sign = word == "tan" ? 1 : -1;
      const Term t = f(word == "tan" ? Op::tan : Op::tanh), slope = 1.0 + sign * (t * t);
      return chain(a, t, slope, (2 * sign) * (t * slope));
    }
    if (word == "atan") {
      const Term slope = 1.0 / (1.0 + x * x);
      return chain(a, f(Op::atan), slope, -2.0 * (x * (slope * slope)));
    }
    const double sign = word == "asin" ? 1 : -1;
    const Term slope = sign / apply(Op::square_root, 1.0 - x * x);
    return chain(a, f(word == "asin" ? Op::asin : Op::acos), slope, x * (slope * (slope * slope)));
  }

  static J of_two(const std::string& word, const J& a, const J& b) {
    const auto f = [&](Op op, const J& x, const J& y) { return J(apply(op, x.value, y.value)); };
    if (word == "+") return a + b;
    if (word == "-") return a - b;
    if (word == "*") return a * b;
    if (word == "/") return a / b;
    if (word == "^" || word == "pow") return power(a, b);
    if (word == "atan2") return angle(a, b);
    if (word == "<") return f(Op::less, a, b);
    if (word == ">") return f(Op::less, b, a);
    if (word == "<=") return f(Op::less_equal, a, b);
    if (word == ">=") return f(Op::less_equal, b, a);
    if (word == "==") return f(Op::equal, a, b);
    if (word == "!=") return J(apply(Op::negated, apply(Op::equal, a.value, b.value)));
    if (word == "and") return f(Op::both, a, b);
    if (word == "or") return f(Op::either, a, b);
    return extreme(word == "min" ? Op::min : Op::max, a, b);
  }

  /// A call of a tree, whose arguments are evaluated.
  static J call(const Node& node, const std::vector<J>& values) {
    const auto argument = [&](std::size_t i) -> const J& {
      return values[static_cast<std::size_t>(node.arguments[i])];
    };
    if (node.word == "if") return choose(argument(0).value, argument(1), argument(2));
    if (node.arguments.size() == 1) return of_one(node.word, argument(0));
    J result = of_two(node.word, argument(0), argument(1));
    for (std::size_t i = 2; i < node.arguments.size(); ++i) result = of_two(node.word, result, argument(i));
    return result;
  }
};

}  // namespace drape::formula
