#include "plugins/energy/formula/compile.h"

#include <map>
#include <string>
#include <type_traits>

#include "core/numerics/elements/green_strain.h"
#include "plugins/energy/formula/differentiate.h"

namespace drape::formula {
namespace {

/// Jets of a law's names, and then of its parts.
template <int N>
class Compiler {
 public:
  using J = Jet<N, Term>;

  Compiler(const Law& law, const Material& material) : law_(law) {
    for (const Symbol& s : symbols_of(law.kind))
      if (is_of_material(s.name)) names_[s.name] = J(material_value(s.name, material));
    for (const Constant& c : law.constants) names_[c.name] = J(c.value);
  }

  void define(const std::string& name, const J& jet) { names_[name] = jet; }
  template <class Input>
  void define(const std::string& name, Input input) {
    define(name, J(read(input)));
  }
  template <class Input>
  Term read(Input input) {
    return graph_.input(static_cast<int>(input));
  }
  template <class Input>
  J variable(Input input, int i) {
    return J::variable(read(input), i);
  }

  Programs compile() {
    J energy(0.0);
    for (const Part& part : law_.parts) names_[part.name] = energy = of_tree(part.tree);
    if (law_.per_area) energy = names_.at("area") * energy;
    std::vector<Term> all = {energy.value};
    all.insert(all.end(), std::begin(energy.first), std::end(energy.first));
    all.insert(all.end(), std::begin(energy.second), std::end(energy.second));
    Programs programs{Program({energy.value}), Program({all.begin(), all.begin() + 1 + N}),
                      Program({all.begin() + 1, all.end()}), Program(all), true};
    for (const Term& t : energy.second) programs.is_linear = programs.is_linear && t.is(0);
    return programs;
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
        values.push_back(Differentiate<N>::call(node, values));
    }
    return values.back();
  }

  /// log(J), which is defined apart, since J itself has lost digits of small strains.
  const J* known_logarithm(const Node& node, const Tree& tree) const {
    if (node.word != "log") return nullptr;
    const Node& argument = tree[static_cast<std::size_t>(node.arguments[0])];
    const auto found = names_.find("log " + argument.word);
    return argument.kind == Node::Kind::name && found != names_.end() ? &found->second : nullptr;
  }

  const Law& law_;
  TermGraph graph_;
  std::map<std::string, J> names_;
};

template <int N>
void define_rest(Compiler<N>& c) {
  using I = TriangleInput;
  c.define("area", I::area);
  c.define("u", I::u);
  c.define("v", I::v);
  c.define("w", I::w);
}

}  // namespace

Programs compile_triangle(const Law& law, const Material& material, TriangleVariables variables) {
  using I = TriangleInput;
  if (variables == TriangleVariables::stretches) {
    Compiler<2> c(law, material);
    define_rest(c);
    const Jet<2, Term> s1 = c.variable(I::s1, 0), s2 = c.variable(I::s2, 1), one(1.0), half(0.5);
    c.define("s1", s1);
    c.define("s2", s2);
    c.define("J", s1 * s2);
    c.define("g11", half * ((s1 - one) * (s1 + one)));
    c.define("g22", half * ((s2 - one) * (s2 + one)));
    c.define("g12", Jet<2, Term>(0.0));
    return c.compile();
  }
  const auto define_strains = [](auto& c) {
    define_rest(c);
    c.define("g11", c.variable(I::g11, 0));
    c.define("g22", c.variable(I::g22, 1));
    c.define("g12", c.variable(I::g12, 2));
    using J = typename std::remove_reference_t<decltype(c)>::J;
    const auto ratio =
        area_ratio<J::variables>(c.read(I::g11), c.read(I::g22), c.read(I::g12), c.read(I::det));
    c.define("J", J(ratio));
    c.define("log J", log(ratio));
  };
  if (variables == TriangleVariables::strains) {
    Compiler<3> c(law, material);
    define_strains(c);
    return c.compile();
  }
  Compiler<5> c(law, material);
  define_strains(c);
  c.define("s1", c.variable(I::s1, 3));
  c.define("s2", c.variable(I::s2, 4));
  return c.compile();
}

Programs compile_hinge(const Law& law, const Material& material) {
  using I = HingeInput;
  Compiler<1> c(law, material);
  for (const auto& [name, input] :
       {std::pair{"rest", I::rest}, std::pair{"length", I::length}, std::pair{"h1", I::h1},
        std::pair{"h2", I::h2}, std::pair{"area", I::area}, std::pair{"u", I::u}, std::pair{"v", I::v},
        std::pair{"w", I::w}})
    c.define(name, input);
  const Jet<1, Term> bend = c.variable(I::bend, 0), rest(c.read(I::rest));
  c.define("bend", bend);
  c.define("theta", bend + rest);
  return c.compile();
}

Programs compile_vertex(const Law& law, const Material& material) {
  using I = VertexInput;
  Compiler<3> c(law, material);
  c.define("x", c.variable(I::x, 0));
  c.define("y", c.variable(I::y, 1));
  c.define("z", c.variable(I::z, 2));
  for (const auto& [name, input] : {std::pair{"u", I::u}, std::pair{"v", I::v}, std::pair{"w", I::w},
                                    std::pair{"area", I::area}, std::pair{"mass", I::mass}})
    c.define(name, input);
  return c.compile();
}

}  // namespace drape::formula
