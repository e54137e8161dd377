#include <algorithm>
#include <map>
#include <optional>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "plugins/energy/formula/functions.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {
namespace {

/// A node's type. Without a dimension it fits any: zero, or a constant without a unit.
struct Quantity {
  bool is_condition = false;
  std::optional<Dimension> dimension = Dimension();
  std::optional<double> number = {};  ///< of literal numbers and their sums and products

  bool fits(const Dimension& wanted) const { return !dimension || *dimension == wanted; }
};

class Checker {
 public:
  Checker(const Law& law, const Tree& tree) : law_(law), tree_(tree) {}

  /// Types of all nodes.
  const std::vector<Quantity>& check() {
    for (const Node& node : tree_) types_.push_back(type_of(node));
    return types_;
  }

 private:
  Quantity type_of(const Node& node) const {
    switch (node.kind) {
      case Node::Kind::number:
        return {false, node.number == 0 ? std::nullopt : std::optional(Dimension()), node.number};
      case Node::Kind::name:
        return type_of_name(node);
      case Node::Kind::call:
        break;
    }
    return type_of_call(node);
  }

  Quantity type_of_name(const Node& node) const {
    for (const Constant& c : law_.constants)
      if (c.name == node.word) return {false, c.unit.empty() ? std::nullopt : dimension_of(c.unit), {}};
    for (const Part& part : law_.parts)
      if (part.name == node.word) return {part.is_condition, part.dimension, {}};
    for (const Symbol& s : symbols_of(law_.kind))
      if (s.name == node.word) return {false, dimension_of(s.unit), {}};
    refuse_name(node);
  }

  [[noreturn]] void refuse_name(const Node& node) const {
    const std::string name = "\"" + excerpt(node.word) + "\"";
    if (find_function(node.word, 0))
      throw Fault(node.at, name + " is a function; write " + node.word + "(…)");
    for (const ElementKind other : {ElementKind::triangle, ElementKind::hinge, ElementKind::vertex})
      for (const Symbol& s : symbols_of(other))
        if (s.name == node.word)
          throw Fault(node.at, name + " is for \"per: " + name_of(other) + "\"; " + offered());
    std::vector<std::string> known;
    for (const Constant& c : law_.constants) known.push_back(c.name);
    for (const Part& part : law_.parts) known.push_back(part.name);
    for (const Symbol& s : symbols_of(law_.kind)) known.push_back(s.name);
    const std::string nearest = nearest_word(node.word, known);
    throw Fault(node.at, "unknown name " + name + "; " +
                             (nearest.empty() ? offered() : "did you mean \"" + nearest + "\"?"));
  }

  std::string offered() const {
    std::vector<std::string> own;
    for (const Symbol& s : symbols_of(law_.kind)) own.push_back(s.name);
    std::string text = "a " + name_of(law_.kind) + " offers " + joined(own);
    std::vector<std::string> constants;
    for (const Constant& c : law_.constants) constants.push_back(c.name);
    if (!constants.empty()) text += "; its constants are " + joined(constants);
    return text;
  }

  Quantity type_of_call(const Node& node) const {
    const Function* f = find_function(node.word, node.arguments.size());
    if (!f) {
      std::vector<std::string> known;
      for (const Function& other : functions())
        if (!other.description.empty()) known.push_back(other.name);
      const std::string nearest = nearest_word(node.word, known);
      throw Fault(node.at,
                  "unknown function \"" + excerpt(node.word) + "\"; " +
                      (nearest.empty() ? "known: " + joined(known) : "did you mean \"" + nearest + "\"?"));
    }
    const auto count = static_cast<int>(node.arguments.size());
    if (count < f->least || count > f->most)
      throw Fault(node.at, "\"" + f->name + "\" takes " + std::to_string(f->least) +
                               (f->most > f->least ? " to " + std::to_string(f->most) : "") +
                               (f->most == 1 ? " argument, not " : " arguments, not ") +
                               std::to_string(count));
    using U = Function::Units;
    for (int i = 0; i < count; ++i) {
      const bool wanted = f->units == U::logical || (f->units == U::choice && i == 0);
      const int argument = node.arguments[static_cast<std::size_t>(i)];
      if (types_[argument].is_condition == wanted) continue;
      throw Fault(tree_[argument].at, wanted
                                          ? "a condition is wanted here, as in x > 0"
                                          : "a condition is no number; choose one with if(condition, a, b)");
    }
    return type_of_valid_call(node, *f);
  }

  const Quantity& argument(const Node& node, std::size_t i) const { return types_[node.arguments[i]]; }

  Quantity type_of_valid_call(const Node& node, const Function& f) const {
    using U = Function::Units;
    const auto first = [&] { return argument(node, 0); };
    switch (f.units) {
      case U::equal:
        return {false, common(node, 0), sum(node)};
      case U::angle:
        common(node, 0);
        return {};
      case U::reads:
        common(node, 0);
        return {true, Dimension(), {}};
      case U::logical:
        return {true, Dimension(), {}};
      case U::choice:
        return {false, common(node, 1), {}};
      case U::none:
        require_none(node, 0, "\"" + f.name + "\" takes a number without a unit");
        return {};
      case U::root:
        return {false, first().dimension ? std::optional(first().dimension->to(0.5)) : std::nullopt, {}};
      case U::product:
      case U::quotient:
        return product(node, f.units == U::product);
      case U::power:
        break;
    }
    return power(node);
  }

  /// Literal numbers that are added, subtracted or negated.
  std::optional<double> sum(const Node& node) const {
    if (node.word != "+" && node.word != "-") return std::nullopt;
    const auto a = argument(node, 0).number;
    if (node.arguments.size() == 1) return a ? std::optional(-*a) : std::nullopt;
    const auto b = argument(node, 1).number;
    if (!a || !b) return std::nullopt;
    return node.word == "+" ? *a + *b : *a - *b;
  }

  Quantity product(const Node& node, bool times) const {
    const Quantity &a = argument(node, 0), &b = argument(node, 1);
    Quantity result{false, std::nullopt, {}};
    if (a.number && b.number) result.number = times ? *a.number * *b.number : *a.number / *b.number;
    if (a.dimension && b.dimension)
      result.dimension = times ? *a.dimension * *b.dimension : *a.dimension / *b.dimension;
    return result;
  }

  Quantity power(const Node& node) const {
    const Quantity& base = argument(node, 0);
    require_none(node, 1, "an exponent is a number without a unit");
    if (!base.dimension) return {false, std::nullopt, {}};
    if (base.dimension->is_none()) return {};
    if (const auto exponent = argument(node, 1).number) return {false, base.dimension->to(*exponent), {}};
    throw Fault(tree_[node.arguments[1]].at, "the exponent of a quantity in " + base.dimension->text() +
                                                 " must be a literal number, as in x^2");
  }

  void require_none(const Node& node, std::size_t i, const std::string& what) const {
    const Quantity& q = argument(node, i);
    if (!q.fits(Dimension()))
      throw Fault(tree_[node.arguments[i]].at, what + ", not one in " + q.dimension->text());
  }

  /// The dimension of the arguments from `begin` on, which must be the same.
  std::optional<Dimension> common(const Node& node, std::size_t begin) const {
    std::optional<Dimension> dimension;
    for (std::size_t i = begin; i < node.arguments.size(); ++i) {
      const Quantity& q = argument(node, i);
      if (!q.dimension) continue;
      if (!dimension) dimension = q.dimension;
      if (*dimension == *q.dimension) continue;
      const bool named = node.word[0] >= 'a' && node.word[0] <= 'z';
      throw Fault(node.at, "\"" + node.word + "\" " + (named ? "takes " : "joins ") + dimension->text() +
                               " and " + q.dimension->text() + "; both must have one unit");
    }
    return dimension;
  }

  const Law& law_;
  const Tree& tree_;
  std::vector<Quantity> types_;
};

/// Whether the tree has a quantity with a unit in it.
bool has_units(const Law& law, const Tree& tree) {
  return std::any_of(tree.begin(), tree.end(), [&](const Node& node) {
    if (node.kind != Node::Kind::name) return false;
    for (const Constant& c : law.constants)
      if (c.name == node.word) return !c.unit.empty();
    for (const Part& part : law.parts)
      if (part.name == node.word) return part.has_units;
    for (const Symbol& s : symbols_of(law.kind))
      if (s.name == node.word) return s.unit != "1" && s.unit != "rad";
    return false;
  });
}

void require_energy(const Law& law, const Part& part) {
  if (part.is_condition)
    throw Fault(part.tree.back().at,
                "the energy is a condition, not a number; choose one with if(condition, a, b)");
  const Dimension wanted = *dimension_of(law.per_area ? "J/m²" : "J");
  if (!part.dimension || *part.dimension == wanted || !part.has_units) return;
  const Dimension missing = wanted / *part.dimension;
  throw Fault(0, std::string(law.per_area ? "the density" : "the energy") + " is in " +
                     part.dimension->text() + " and must be in " + wanted.text() +
                     (missing == *dimension_of("m") && law.kind == ElementKind::triangle
                          ? "; a modulus in Pa times \"thickness\" is one of the surface"
                          : "; a factor in " + missing.text() + " is missing"));
}

}  // namespace

void append_part(Law& law, const std::string& name, const std::string& text, bool is_energy) {
  Part part;
  part.name = name;
  part.text = text;
  part.tree = parse(text);
  const Quantity type = Checker(law, part.tree).check().back();
  part.is_condition = type.is_condition;
  part.dimension = type.dimension;
  part.has_units = has_units(law, part.tree);
  if (is_energy) require_energy(law, part);
  law.parts.push_back(std::move(part));
}

bool Law::uses(const std::string& symbol) const {
  std::vector<std::string> used;  // names that the energy needs
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    const bool needed =
        part == parts.rbegin() || std::find(used.begin(), used.end(), part->name) != used.end();
    for (const Node& node : part->tree)
      if (needed && node.kind == Node::Kind::name) used.push_back(node.word);
  }
  return std::find(used.begin(), used.end(), symbol) != used.end();
}

std::string with_caret(const std::string& text, const Fault& fault) {
  const std::size_t at = std::min(fault.at, text.size());
  const std::size_t begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  const std::size_t end = std::min(text.find('\n', at), text.size());
  constexpr std::size_t before = 50, after = 30;  // columns around the place that are shown
  const std::size_t from = at - begin > before ? at - before : begin;
  std::size_t to = std::min(end, at + after);
  while (to < end && (static_cast<unsigned char>(text[to]) & 0xc0) == 0x80) ++to;
  const std::string head = (from > begin ? "…" : "") + text.substr(from, at - from);
  return "    " + head + text.substr(at, to - at) + (to < end ? "…" : "") + "\n    " +
         std::string(display_width(head), ' ') + "^";
}

}  // namespace drape::formula
