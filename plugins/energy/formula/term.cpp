#include "plugins/energy/formula/term.h"

#include <bit>
#include <cmath>
#include <stdexcept>

namespace drape::formula {

int arguments_of(Op op) {
#define DRAPE_CASE(op) case Op::op:
  switch (op) {
    case Op::input:
      return 0;
      DRAPE_OPS_OF_TWO(DRAPE_CASE)
      return 2;
      DRAPE_OPS_OF_THREE(DRAPE_CASE)
      return 3;
    default:
      return 1;
  }
#undef DRAPE_CASE
}

namespace {

bool same(const Term& a, const Term& b) {
  return a.graph == b.graph && a.node == b.node && (a.graph || a.literal == b.literal);
}

/// The node of a term; null for a literal.
const TermGraph::Node* node_of(const Term& t) { return t.graph ? &(*t.graph)[t.node] : nullptr; }

bool is_op(const Term& t, Op op) { return t.graph && node_of(t)->op == op; }

/// Whether 1/x is exact.
bool is_power_of_two(double x) {
  int exponent = 0;
  return std::isnormal(x) && std::abs(std::frexp(x, &exponent)) == 0.5 && std::abs(exponent) < 1000;
}

/// A product and a sum in one.
Term fused(const Term& product, const Term& b) {
  const TermGraph::Node node = *node_of(product);
  return apply(Op::multiply_add, node.arguments[0], node.arguments[1], b);
}

}  // namespace

Term apply(Op op, const Term& a, const Term& b, const Term& c) {
  const int count = arguments_of(op);
  const bool literal = !a.graph && (count < 2 || !b.graph) && (count < 3 || !c.graph);
  if (literal) return Term(evaluate<double>(op, a.literal, b.literal, c.literal));
  if (op == Op::choose && !a.graph) return a.literal != 0 ? b : c;
  if (op == Op::choose && same(b, c)) return b;
  TermGraph* graph = a.graph ? a.graph : b.graph ? b.graph : c.graph;
  return graph->node(op, a, count > 1 ? b : Term(), count > 2 ? c : Term());
}

Term operator+(const Term& a, const Term& b) {
  if (a.is(0)) return b;
  if (b.is(0)) return a;
  if (is_op(b, Op::negate)) return a - node_of(b)->arguments[0];
  if (is_op(a, Op::negate)) return b - node_of(a)->arguments[0];
  if (a.graph && is_op(b, Op::multiply)) return fused(b, a);
  if (b.graph && is_op(a, Op::multiply)) return fused(a, b);
  return apply(Op::add, a, b);
}

Term operator-(const Term& a, const Term& b) {
  if (b.is(0)) return a;
  if (a.is(0)) return -b;
  if (same(a, b)) return Term(0.0);
  if (is_op(b, Op::negate)) return a + node_of(b)->arguments[0];
  if (is_op(a, Op::add))  // (x + b) - b
    for (int i = 0; i < 2; ++i)
      if (same(node_of(a)->arguments[i], b)) return node_of(a)->arguments[1 - i];
  return apply(Op::subtract, a, b);
}

Term operator*(const Term& a, const Term& b) {
  if (!a.graph && !b.graph) return Term(a.literal * b.literal);
  if (a.is(0) || b.is(0)) return Term(0.0);
  if (a.is(1)) return b;
  if (b.is(1)) return a;
  if (a.is(-1)) return -b;
  if (b.is(-1)) return -a;
  if (is_op(a, Op::negate)) return -(node_of(a)->arguments[0] * b);
  if (is_op(b, Op::negate)) return -(a * node_of(b)->arguments[0]);
  if (!b.graph) return b * a;  // literals first
  if (!a.graph && is_op(b, Op::multiply) && !node_of(b)->arguments[0].graph)
    return Term(a.literal * node_of(b)->arguments[0].literal) * node_of(b)->arguments[1];
  if (a.graph && is_op(a, Op::multiply) && !node_of(a)->arguments[0].graph)
    return node_of(a)->arguments[0] * (node_of(a)->arguments[1] * b);
  if (is_op(b, Op::multiply) && !node_of(b)->arguments[0].graph)
    return node_of(b)->arguments[0] * (a * node_of(b)->arguments[1]);
  return apply(Op::multiply, a, b);
}

Term operator/(const Term& a, const Term& b) {
  if (a.is(0)) return Term(0.0);
  if (b.is(1)) return a;
  if (!b.graph && is_power_of_two(b.literal)) return Term(1 / b.literal) * a;
  return apply(Op::divide, a, b);
}

Term operator-(const Term& a) {
  if (!a.graph) return Term(-a.literal);
  if (is_op(a, Op::negate)) return node_of(a)->arguments[0];
  if (is_op(a, Op::multiply) && !node_of(a)->arguments[0].graph)
    return Term(-node_of(a)->arguments[0].literal) * node_of(a)->arguments[1];
  return apply(Op::negate, a);
}

Term TermGraph::find_or_add(const Key& key, Node node) {
  const auto [found, is_new] = index_.try_emplace(key, static_cast<int>(nodes_.size()));
  if (is_new) {
    if (nodes_.size() >= most_nodes)
      throw std::length_error("the formula needs more than " + std::to_string(most_nodes) +
                              " operations for its derivatives; shorten it");
    nodes_.push_back(node);
  }
  return {this, found->second};
}

Term TermGraph::input(int number) {
  Node node;
  node.input = number;
  return find_or_add({Op::input, {number}}, node);
}

Term TermGraph::node(Op op, const Term& a, const Term& b, const Term& c) {
  Node node{op, {a, b, c}, 0};
  const bool commutes =
      op == Op::add || op == Op::multiply || op == Op::multiply_add || op == Op::both || op == Op::either;
  if (commutes && a.node > b.node) std::swap(node.arguments[0], node.arguments[1]);
  Key key{op, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Term& t = node.arguments[i];
    key.words[2 * i] = t.graph ? t.node : -1;
    key.words[2 * i + 1] = t.graph ? 0 : std::bit_cast<std::int64_t>(t.literal);
  }
  return find_or_add(key, node);
}

}  // namespace drape::formula
