#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "core/numerics/linear_algebra/pack_functions.h"

namespace drape::formula {

// F(op) for the operations of one, two and three arguments.
#define DRAPE_OPS_OF_ONE(F) F(negate) F(negated) DRAPE_FUNCTIONS(F)
#define DRAPE_OPS_OF_TWO(F) \
  F(add)                    \
  F(subtract)               \
  F(multiply) F(divide) F(pow) F(atan2) F(min) F(max) F(less) F(less_equal) F(equal) F(both) F(either)
#define DRAPE_OPS_OF_THREE(F) F(choose) F(multiply_add)
#define DRAPE_OPS(F) DRAPE_OPS_OF_ONE(F) DRAPE_OPS_OF_TWO(F) DRAPE_OPS_OF_THREE(F)

/// Operations of a program. Conditions are 0 or 1; one of a NaN is NaN. The last six are those of programs
/// alone, with a literal l: l, l a, l + a, l - a, l / a, l a + b.
#define DRAPE_ENUMERATOR(op) op,
enum class Op : std::uint8_t {
  input,
  DRAPE_OPS(DRAPE_ENUMERATOR) load,
  scale,
  offset,
  subtract_from,
  divide_into,
  scale_add
};
#undef DRAPE_ENUMERATOR

/// Number of arguments.
int arguments_of(Op op);

/// 1 where the mask holds, else 0; NaN where a or b is.
template <class T, class Mask>
T condition(const Mask& mask, const T& a, const T& b) {
  const T truth = select(mask, T(1.0), T(0.0));
  return select((a == a) & (b == b), truth, T(std::numeric_limits<double>::quiet_NaN()));
}

/// The result of an operation between input and load, on double or Pack.
template <class T>
[[gnu::always_inline]] inline T evaluate(Op op, const T& a, const T& b, const T& c) {
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp, std::expm1,
      std::log, std::log1p, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
#define DRAPE_CASE(op, result) \
  case Op::op:                 \
    return result;
#define DRAPE_FUNCTION_CASE(name) DRAPE_CASE(name, name(a))
  switch (op) {
    DRAPE_FUNCTIONS(DRAPE_FUNCTION_CASE)
    DRAPE_CASE(add, a + b)
    DRAPE_CASE(subtract, a - b)
    DRAPE_CASE(multiply, a * b)
    DRAPE_CASE(divide, a / b)
    DRAPE_CASE(negate, -a)
    DRAPE_CASE(pow, pow(a, b))
    DRAPE_CASE(atan2, atan2(a, b))
    DRAPE_CASE(min, select(b == b, select(b < a, b, a), b))
    DRAPE_CASE(max, select(b == b, select(b > a, b, a), b))
    DRAPE_CASE(less, condition(a < b, a, b))
    DRAPE_CASE(less_equal, condition(a <= b, a, b))
    DRAPE_CASE(equal, condition(a == b, a, b))
    DRAPE_CASE(both, a * b)
    DRAPE_CASE(either, a + b - a * b)
    DRAPE_CASE(negated, 1.0 - a)
    DRAPE_CASE(multiply_add, a * b + c)
    DRAPE_CASE(choose, select(a == a, select(a == 0.0, c, b), a))
    default:
      return T(std::numeric_limits<double>::quiet_NaN());
  }
#undef DRAPE_FUNCTION_CASE
#undef DRAPE_CASE
}

class TermGraph;
struct Term;

/// Any operation; literals are evaluated.
Term apply(Op op, const Term& a, const Term& b, const Term& c);

/// A number that a program computes: a literal, or a node of a graph. With its operators a Jet of terms
/// derives the program of the derivatives.
struct Term {
  TermGraph* graph = nullptr;  ///< null: a literal
  int node = -1;
  double literal = 0;

  Term() = default;
  Term(double value) : literal(value) {}
  Term(TermGraph* graph_in, int node_in) : graph(graph_in), node(node_in) {}
  bool is(double value) const { return !graph && literal == value; }

  // What jets of terms call (core/numerics/elements/jet_functions.h).
#define DRAPE_OPERATION(name) \
  friend Term name(const Term& a) { return apply(Op::name, a, {}, {}); }
  DRAPE_FUNCTIONS(DRAPE_OPERATION)
#undef DRAPE_OPERATION
  friend Term atan2(const Term& y, const Term& x) { return apply(Op::atan2, y, x, {}); }
  friend Term pow(const Term& a, const Term& b) { return apply(Op::pow, a, b, {}); }
  friend Term min(const Term& a, const Term& b) { return apply(Op::min, a, b, {}); }
  friend Term max(const Term& a, const Term& b) { return apply(Op::max, a, b, {}); }
  friend Term operator<(const Term& a, const Term& b) { return apply(Op::less, a, b, {}); }
  friend Term select(const Term& condition, const Term& a, const Term& b) {
    return apply(Op::choose, condition, a, b);
  }
};
Term operator+(const Term& a, const Term& b);
Term operator-(const Term& a, const Term& b);
Term operator*(const Term& a, const Term& b);
Term operator/(const Term& a, const Term& b);
Term operator-(const Term& a);
inline Term apply(Op op, const Term& a, const Term& b = {}) { return apply(op, a, b, {}); }

/// The terms of a program. Equal terms are one node, so nothing is computed twice.
class TermGraph {
 public:
  struct Node {
    Op op = Op::input;
    std::array<Term, 3> arguments;
    int input = 0;  ///< of Op::input
  };
  static constexpr std::size_t most_nodes = 20000;

  Term input(int number);
  /// The node of an operation that is not simplified further. Throws std::length_error beyond most_nodes.
  Term node(Op op, const Term& a, const Term& b, const Term& c);
  const Node& operator[](int node) const { return nodes_[static_cast<std::size_t>(node)]; }

 private:
  struct Key {
    Op op;
    std::array<std::int64_t, 6> words;
    auto operator<=>(const Key&) const = default;
  };

  Term find_or_add(const Key& key, Node node);

  std::vector<Node> nodes_;
  std::map<Key, int> index_;
};

}  // namespace drape::formula
