#include <algorithm>
#include <optional>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {
namespace {

std::string in_quotes(const std::string& word) { return "\"" + excerpt(word) + "\""; }

/// How a number gets a unit: a literal has none.
std::string constant_hint(const Dimension& unit) {
  return "; a number that has this unit is a constant, as in constants: {c: {value: 1, unit: " + unit.text() +
         "}}";
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

class Checker {
 public:
  Checker(const Law& law, const Tree& tree) : law_(law), tree_(tree) {}

  /// The type of the whole.
  Quantity check() {
    for (const Node& node : tree_) {
      Quantity type = type_of(node);
      for (const int argument : node.arguments) type.has_units |= types_[argument].has_units;
      types_.push_back(type);
    }
    return types_.back();
  }

 private:
  Quantity type_of(const Node& node) const {
    if (node.kind == Node::Kind::call) return type_of_call(node);
    if (node.kind == Node::Kind::name) return type_of_name(node);
    Quantity number{.number = node.number};
    if (node.number == 0) number.dimension.reset();
    return number;
  }

  Quantity type_of_name(const Node& node) const {
    if (const NamedConstant* c = find_named(law_.constants, node.word))
      return {.dimension = c->unit.empty() ? std::nullopt : dimension_of(c->unit),
              .has_units = !c->unit.empty()};
    if (const Part* part = find_named(law_.parts, node.word)) {
      Quantity type = part->type;
      type.number.reset();
      return type;
    }
    if (const Symbol* s = find_named(symbols_of(law_.kind), node.word))
      return {.dimension = dimension_of(s->unit), .has_units = s->unit != "1" && s->unit != "rad"};
    refuse_name(node);
  }

  [[noreturn]] void refuse_name(const Node& node) const {
    if (find_function(node.word, 0))
      throw Fault(node.at, in_quotes(node.word) + " is a function; write " + node.word + "(…)");
    std::vector<std::string> symbols = names_of(symbols_of(law_.kind)), constants = names_of(law_.constants);
    std::string offered = "a " + name_of(law_.kind) + " offers " + joined(symbols);
    if (!constants.empty()) offered += "; its constants are " + joined(constants);
    for (const ElementKind other : element_kinds)
      if (find_named(symbols_of(other), node.word))
        throw Fault(node.at, in_quotes(node.word) + " is for \"per: " + name_of(other) + "\"; " + offered);
    std::vector<std::string> known = std::move(constants);
    for (const auto& names : {names_of(law_.parts), symbols})
      known.insert(known.end(), names.begin(), names.end());
    throw Fault(node.at,
                "unknown name " + in_quotes(node.word) + "; " + did_you_mean(node.word, known, offered));
  }

  Quantity type_of_call(const Node& node) const {
    const Function* f = find_function(node.word, node.arguments.size());
    if (!f) refuse_function(node);
    const auto count = static_cast<int>(node.arguments.size());
    if (count < f->least || count > f->most)
      throw Fault(node.at, "\"" + f->name + "\" takes " + std::to_string(f->least) +
                               (f->most > f->least ? " to " + std::to_string(f->most) : "") +
                               (f->most == 1 ? " argument, not " : " arguments, not ") +
                               std::to_string(count));
    for (int i = 0; i < count; ++i) {
      const bool wanted =
          f->units == Function::Units::logical || (f->units == Function::Units::choice && i == 0);
      if (argument(node, i).is_condition == wanted) continue;
      throw Fault(tree_[node.arguments[i]].at,
                  wanted ? "a condition is wanted here, as in x > 0"
                         : "a condition is no number; choose one with if(condition, a, b)");
    }
    return type_of_valid_call(node, *f);
  }

  [[noreturn]] static void refuse_function(const Node& node) {
    std::vector<std::string> known;
    for (const Function& other : functions())
      if (!other.description.empty()) known.push_back(other.name);
    throw Fault(node.at, "unknown function " + in_quotes(node.word) + "; " +
                             did_you_mean(node.word, known, "known: " + joined(known)));
  }

  const Quantity& argument(const Node& node, std::size_t i) const { return types_[node.arguments[i]]; }

  Quantity type_of_valid_call(const Node& node, const Function& f) const {
    using U = Function::Units;
    switch (f.units) {
      case U::equal:
        return {.dimension = common(node, 0), .number = sum(node)};
      case U::angle:
        common(node, 0);
        return {};
      case U::reads:
        common(node, 0);
        return {.is_condition = true};
      case U::logical:
        return {.is_condition = true};
      case U::choice:
        return {.dimension = common(node, 1)};
      case U::none:
        require_none(node, 0, "\"" + f.name + "\" takes a number without a unit");
        return {};
      case U::root: {
        const auto& dimension = argument(node, 0).dimension;
        return {.dimension = dimension ? std::optional(dimension->to(0.5)) : std::nullopt};
      }
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
    Quantity result{.dimension = std::nullopt};
    if (a.number && b.number) result.number = times ? *a.number * *b.number : *a.number / *b.number;
    if (a.dimension && b.dimension)
      result.dimension = times ? *a.dimension * *b.dimension : *a.dimension / *b.dimension;
    return result;
  }

  Quantity power(const Node& node) const {
    const auto& base = argument(node, 0).dimension;
    require_none(node, 1, "an exponent is a number without a unit");
    if (!base || base->is_none()) return {.dimension = base};
    if (const auto exponent = argument(node, 1).number) return {.dimension = base->to(*exponent)};
    throw Fault(tree_[node.arguments[1]].at,
                "the exponent of a quantity in " + base->text() + " must be a literal number, as in x^2");
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
                               " and " + q.dimension->text() + "; both must have one unit" +
                               (dimension->is_none()     ? constant_hint(*q.dimension)
                                : q.dimension->is_none() ? constant_hint(*dimension)
                                                         : std::string()));
    }
    return dimension;
  }

  const Law& law_;
  const Tree& tree_;
  std::vector<Quantity> types_;
};

void require_energy(const Law& law, const Part& part) {
  const Quantity& type = part.type;
  if (type.is_condition)
    throw Fault(part.tree.back().at,
                "the energy is a condition, not a number; choose one with if(condition, a, b)");
  const Dimension wanted = *dimension_of(law.per_area ? "J/m²" : "J");
  if (type.fits(wanted) || !type.has_units) return;
  const Dimension missing = wanted / *type.dimension;
  throw Fault(0, std::string(law.per_area ? "the density" : "the energy") + " is in " +
                     type.dimension->text() + " and must be in " + wanted.text() +
                     (missing == *dimension_of("m") && law.kind == ElementKind::triangle
                          ? "; a modulus in Pa times \"thickness\" is one of the surface"
                          : "; a factor in " + missing.text() + " is missing" + constant_hint(missing)));
}

}  // namespace

void append_part(Law& law, const std::string& name, const std::string& text, bool is_energy) {
  Part part{name, text, parse(text), {}};
  part.type = Checker(law, part.tree).check();
  if (is_energy) require_energy(law, part);
  law.parts.push_back(std::move(part));
}

bool Law::uses(const std::string& symbol) const {
  std::vector<std::string> used;  // names that the energy needs
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    const bool needed = part == parts.rbegin() || is_one_of(part->name, used);
    for (const Node& node : part->tree)
      if (needed && node.kind == Node::Kind::name) used.push_back(node.word);
  }
  return is_one_of(symbol, used);
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
