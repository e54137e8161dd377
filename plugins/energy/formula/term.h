#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

namespace drape::formula {

/// Operations of a program. Conditions are 0 or 1; one of a NaN is NaN.
enum class Op : std::uint8_t {
  input,
  add,
  subtract,
  multiply,
  divide,
  negate,
  square_root,
  exp,
  expm1,
  log,
  log1p,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  pow,
  abs,
  sign,
  min,
  max,
  less,
  less_equal,
  equal,
  both,
  either,
  negated,
  choose,
  multiply_add,  ///< a b + c
  // In programs alone, with a literal l:
  load,
  scale,
  offset,
  subtract_from,
  divide_into,
  scale_add  ///< l, l a, l + a, l - a, l / a, l a + b
};

/// Number of arguments.
int arguments_of(Op op);

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
#define DRAPE_OPERATION(name, op) \
  friend Term name(const Term& a) { return apply(Op::op, a, {}, {}); }
  DRAPE_OPERATION(sqrt, square_root)
  DRAPE_OPERATION(exp, exp)
  DRAPE_OPERATION(expm1, expm1)
  DRAPE_OPERATION(log, log)
  DRAPE_OPERATION(log1p, log1p)
  DRAPE_OPERATION(sin, sin)
  DRAPE_OPERATION(cos, cos)
  DRAPE_OPERATION(tan, tan)
  DRAPE_OPERATION(asin, asin)
  DRAPE_OPERATION(acos, acos)
  DRAPE_OPERATION(atan, atan)
  DRAPE_OPERATION(sinh, sinh)
  DRAPE_OPERATION(cosh, cosh)
  DRAPE_OPERATION(tanh, tanh)
  DRAPE_OPERATION(abs, abs)
  DRAPE_OPERATION(sign, sign)
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
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };

  Term find_or_add(const Key& key, Node node);

  std::vector<Node> nodes_;
  std::unordered_map<Key, int, Hash> index_;
};

}  // namespace drape::formula
