#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "core/numerics/elements/green_strain.h"
#include "plugins/energy/formula/program.h"

namespace drape::formula {
namespace {

/// Functions and operators of formulas on jets of terms.
template <int N>
struct JetFunctions {
  using J = Jet<N, Term>;

  static bool is_literal(const J& a) {
    bool literal = !a.value.graph;
    for (const Term& t : a.first) literal = literal && t.is(0);
    for (const Term& t : a.second) literal = literal && t.is(0);
    return literal;
  }

  static J of_one(const std::string& word, const J& a) {
#define DRAPE_ENTRY(name) {#name, drape::name},
    static const std::map<std::string, J (*)(const J&)> functions = {DRAPE_FUNCTIONS(DRAPE_ENTRY)};
#undef DRAPE_ENTRY
    if (word == "-") return -a;
    if (word == "not") return J(apply(Op::negated, a.value));
    return functions.at(word)(a);
  }

  static J of_two(const std::string& word, const J& a, const J& b) {
    const auto f = [&](Op op, const J& x, const J& y) { return J(apply(op, x.value, y.value)); };
    if (word == "+") return a + b;
    if (word == "-") return a - b;
    if (word == "*") return a * b;
    if (word == "/") return a / b;
    if (word == "^" || word == "pow") return is_literal(b) ? pow(a, b.value.literal) : pow(a, b);
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
    const auto argument = [&](std::size_t i) -> const J& { return values[node.arguments[i]]; };
    if (node.word == "if") return select(argument(0).value, argument(1), argument(2));
    if (node.arguments.size() == 1) return of_one(node.word, argument(0));
    J result = of_two(node.word, argument(0), argument(1));
    for (std::size_t i = 2; i < node.arguments.size(); ++i) result = of_two(node.word, result, argument(i));
    return result;
  }
};

/// Jets of a law's names, and then of its parts.
template <int N>
class Compiler {
 public:
  using J = Jet<N, Term>;

  /// All symbols of the element are inputs, none of them a variable.
  Compiler(const Law& law, const Material& material) : law_(law), symbols_(symbols_of(law.kind)) {
    for (int i = 0; i < std::ssize(symbols_); ++i) {
      const auto value = symbols_[i].value;
      define(symbols_[i].name, value ? J(value(MaterialSymbols(material))) : J(read(i)));
    }
    for (const NamedConstant& c : law.constants) define(c.name, c.value);
  }

  void define(const std::string& name, const J& jet) { names_[name] = jet; }
  Term read(int input) { return graph_.input(input); }
  /// Makes an input variable i.
  J variable(int input, int i) { return names_[symbols_[input].name] = J::variable(read(input), i); }

  Programs compile() {
    J energy(0.0);
    for (const Part& part : law_.parts) names_[part.name] = energy = of_tree(part.tree);
    if (law_.per_area) energy = names_.at("area") * energy;
    std::vector<Term> all = {energy.value};
    all.insert(all.end(), std::begin(energy.first), std::end(energy.first));
    all.insert(all.end(), std::begin(energy.second), std::end(energy.second));
    return {Program({energy.value}), Program({all.begin(), all.begin() + 1 + N}),
            Program({all.begin() + 1, all.end()}), Program(all)};
  }

 private:
  J of_tree(const Tree& tree) {
    std::vector<J> values;
    for (const Node& node : tree) {
      if (node.kind == Node::Kind::number)
        values.emplace_back(node.number);
      else if (node.kind == Node::Kind::name)
        values.push_back(names_.at(node.word));
      else if (const J* logarithm = known_logarithm(node, tree))
        values.push_back(*logarithm);
      else
        values.push_back(JetFunctions<N>::call(node, values));
    }
    return values.back();
  }

  /// log(J), which is defined apart, since J itself has lost digits of small strains.
  const J* known_logarithm(const Node& node, const Tree& tree) const {
    if (node.word != "log") return nullptr;
    const Node& argument = tree[node.arguments[0]];
    const auto found = names_.find("log " + argument.word);
    return argument.kind == Node::Kind::name && found != names_.end() ? &found->second : nullptr;
  }

  const Law& law_;
  const std::vector<Symbol>& symbols_;
  TermGraph graph_;
  std::map<std::string, J> names_;
};

/// By the strains, which are the first three of N variables.
template <int N>
void define_strains(Compiler<N>& c) {
  using I = TriangleInput;
  for (const int strain : {I::g11, I::g22, I::g12}) c.variable(strain, strain);
  const auto ratio = area_ratio<N>(c.read(I::g11), c.read(I::g22), c.read(I::g12), c.read(I::det));
  c.define("J", ratio);
  c.define("log J", log(ratio));
}

/// By both stretches, of which strains along their axes are functions.
void define_principal_strains(Compiler<2>& c) {
  const Jet<2, Term> s1 = c.variable(TriangleInput::s1, 0), s2 = c.variable(TriangleInput::s2, 1), one(1.0),
                     half(0.5);
  c.define("J", s1 * s2);
  c.define("g11", half * ((s1 - one) * (s1 + one)));
  c.define("g22", half * ((s2 - one) * (s2 + one)));
  c.define("g12", 0.0);
}

template <int N>
Programs compile_triangle_by(const Law& law, const Material& material) {
  Compiler<N> c(law, material);
  if constexpr (N == 2)
    define_principal_strains(c);
  else
    define_strains(c);
  if constexpr (N == 5) {
    c.variable(TriangleInput::s1, 3);
    c.variable(TriangleInput::s2, 4);
  }
  return c.compile();
}

}  // namespace

Programs compile_triangle(const Law& law, const Material& material, TriangleVariables variables) {
  return variables == TriangleVariables::stretches ? compile_triangle_by<2>(law, material)
         : variables == TriangleVariables::strains ? compile_triangle_by<3>(law, material)
                                                   : compile_triangle_by<5>(law, material);
}

Programs compile_hinge(const Law& law, const Material& material) {
  Compiler<1> c(law, material);
  const Jet<1, Term> bend = c.variable(HingeInput::bend, 0), rest(c.read(HingeInput::rest));
  c.define("theta", bend + rest);
  return c.compile();
}

Programs compile_vertex(const Law& law, const Material& material) {
  Compiler<3> c(law, material);
  for (int i = 0; i < 3; ++i) c.variable(i, i);  // x, y and z
  return c.compile();
}

}  // namespace drape::formula
