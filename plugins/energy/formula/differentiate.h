#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/numerics/elements/jet_functions.h"
#include "plugins/energy/formula/syntax.h"
#include "plugins/energy/formula/term.h"

namespace drape::formula {

/// Functions of formulas on jets of terms.
template <int N>
struct Differentiate {
  using J = Jet<N, Term>;

  static bool is_literal(const J& a) {
    bool literal = !a.value.graph;
    for (const Term& t : a.first) literal = literal && t.is(0);
    for (const Term& t : a.second) literal = literal && t.is(0);
    return literal;
  }

  static J power(const J& x, const J& y) { return is_literal(y) ? pow(x, y.value.literal) : pow(x, y); }

  static J of_one(const std::string& word, const J& a) {
    static const std::map<std::string, J (*)(const J&)> functions = {
        {"-", [](const J& x) { return -x; }},
        {"not", [](const J& x) { return J(apply(Op::negated, x.value)); }},
        {"sqrt", drape::sqrt},
        {"exp", drape::exp},
        {"expm1", drape::expm1},
        {"log", drape::log},
        {"log1p", drape::log1p},
        {"sin", drape::sin},
        {"cos", drape::cos},
        {"tan", drape::tan},
        {"asin", drape::asin},
        {"acos", drape::acos},
        {"atan", drape::atan},
        {"sinh", drape::sinh},
        {"cosh", drape::cosh},
        {"tanh", drape::tanh},
        {"abs", drape::abs},
        {"sign", drape::sign}};
    return functions.at(word)(a);
  }

  static J of_two(const std::string& word, const J& a, const J& b) {
    const auto f = [&](Op op, const J& x, const J& y) { return J(apply(op, x.value, y.value)); };
    if (word == "+") return a + b;
    if (word == "-") return a - b;
    if (word == "*") return a * b;
    if (word == "/") return a / b;
    if (word == "^" || word == "pow") return power(a, b);
    if (word == "atan2") return atan2(a, b);
    if (word == "<") return f(Op::less, a, b);
    if (word == ">") return f(Op::less, b, a);
    if (word == "<=") return f(Op::less_equal, a, b);
    if (word == ">=") return f(Op::less_equal, b, a);
    if (word == "==") return f(Op::equal, a, b);
    if (word == "!=") return J(apply(Op::negated, apply(Op::equal, a.value, b.value)));
    if (word == "and") return f(Op::both, a, b);
    if (word == "or") return f(Op::either, a, b);
    return word == "min" ? min(a, b) : max(a, b);
  }

  /// A call of a tree, whose arguments are evaluated.
  static J call(const Node& node, const std::vector<J>& values) {
    const auto argument = [&](std::size_t i) -> const J& {
      return values[static_cast<std::size_t>(node.arguments[i])];
    };
    if (node.word == "if") return select(argument(0).value, argument(1), argument(2));
    if (node.arguments.size() == 1) return of_one(node.word, argument(0));
    J result = of_two(node.word, argument(0), argument(1));
    for (std::size_t i = 2; i < node.arguments.size(); ++i) result = of_two(node.word, result, argument(i));
    return result;
  }
};

}  // namespace drape::formula
