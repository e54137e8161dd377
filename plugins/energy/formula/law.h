#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/numerics/formulas/formula_law.h"

namespace drape::formula {

/// Powers of metre, kilogram and second.
struct Dimension {
  std::array<double, 3> powers{};

  friend Dimension operator*(const Dimension& a, const Dimension& b);
  friend Dimension operator/(const Dimension& a, const Dimension& b) { return a * b.to(-1); }
  Dimension to(double exponent) const;
  bool is_none() const { return *this == Dimension(); }
  bool operator==(const Dimension& other) const;

  /// As SI units: "J/m²", "m^0.5 kg"; "1" without a dimension.
  std::string text() const;
};

/// The dimension of a unit such as "N/m", "J/m^2", "kg m²/s²", "1" or "rad"; none if it is not one in SI
/// units without prefixes.
std::optional<Dimension> dimension_of(const std::string& unit);

/// The kinds of elements that a formula can be about.
enum class ElementKind { triangle, hinge, vertex };
inline constexpr ElementKind element_kinds[] = {ElementKind::triangle, ElementKind::hinge,
                                                ElementKind::vertex};

/// "triangle", "hinge" or "vertex".
std::string name_of(ElementKind kind);

/// Inputs of a program, numbered as the kind's symbols_of. In place of J a triangle has det C; that of theta
/// is not read.
struct TriangleInput {
  enum : int { g11, g22, g12, s1, s2, det, area, u, v, w };
};
struct HingeInput {
  enum : int { theta, rest, bend, length, h1, h2, area, u, v, w };
};

/// A name that a formula may use.
struct Symbol {
  std::string name;
  std::string unit;                              ///< SI
  std::string description;                       ///< one phrase
  double (*value)(const MaterialSymbols&) = {};  ///< of the material's, the same for all elements; else null
};

/// What a kind offers: first what belongs to the element, then the material's.
const std::vector<Symbol>& symbols_of(ElementKind kind);

/// A function or operator of formulas.
struct Function {
  enum class Units {
    equal,     ///< arguments of one dimension, the result's
    none,      ///< arguments and result without a dimension
    angle,     ///< arguments of one dimension, result without
    product,   ///< of the arguments' dimensions
    quotient,  ///< of the arguments' dimensions
    power,     ///< the first to the power of the second
    root,      ///< the square root of the argument's
    reads,     ///< arguments of one dimension, the result is a condition
    logical,   ///< conditions to a condition
    choice     ///< a condition, then two of one dimension, the result's
  };
  std::string name;
  int least, most;  ///< number of arguments
  Units units;
  std::string description;  ///< for the list of functions; empty for operators
};

/// In the order in which they are listed.
const std::vector<Function>& functions();
/// The function or operator called by this name with this number of arguments; null without one of the name.
const Function* find_function(const std::string& name, std::size_t arguments);

/// What each kind offers and the functions, as text for `drape describe formula`.
std::string vocabulary();

/// A fault of a formula and its place: the byte in the text.
class Fault : public std::runtime_error {
 public:
  Fault(std::size_t at_in, const std::string& message) : std::runtime_error(message), at(at_in) {}
  std::size_t at;
};

/// The line of the text that a fault is in, and a caret below its place.
std::string with_caret(const std::string& text, const Fault& fault);

/// A node of a formula's tree: a number, a name, or a function or operator of other nodes.
struct Node {
  enum class Kind { number, name, call };
  Kind kind = Kind::number;
  std::size_t at = 0;          ///< its place in the text; an operator's own
  double number = 0;           ///< of a number
  std::string word;            ///< of a name or a call; "-" of two arguments or of one
  std::vector<int> arguments;  ///< of a call: indices of nodes, all before its own
};

/// A formula as a tree. Every node comes after its arguments, the last is the whole.
using Tree = std::vector<Node>;

inline constexpr std::size_t longest_formula = 4000;  ///< [bytes]
inline constexpr int deepest_formula = 60;            ///< parentheses, functions and powers in each other

/// Parses a formula. Operators from weak to strong: `or`, `and`, `not`, comparisons, `+ -`, `* /`, sign, `^`
/// (from the right; also `**`). Throws Fault.
Tree parse(std::string_view text);

/// The type of a formula.
struct Quantity {
  bool is_condition = false;
  /// None fits any: zero, or a constant without a unit.
  std::optional<Dimension> dimension = Dimension();
  bool has_units = false;             ///< whether a quantity with a unit is in it
  std::optional<double> number = {};  ///< of literal numbers and their sums and products

  bool fits(const Dimension& wanted) const { return !dimension || *dimension == wanted; }
};

/// A named formula: a sub-expression, or the energy itself.
struct Part {
  std::string name;  ///< of a sub-expression, or "density" or "energy"
  std::string text;
  Tree tree;
  Quantity type;
};

/// An energy by formulas, before the material is known.
struct Law {
  ElementKind kind = ElementKind::triangle;
  std::vector<NamedConstant> constants;  ///< units are SI; one without a unit fits any dimension
  std::vector<Part> parts;               ///< each may use those before; the last is the energy
  bool per_area = false;                 ///< the energy is one of a unit of rest area [J/m²]

  /// Whether the energy or what it uses has the symbol in it.
  bool uses(const std::string& symbol) const;
  /// Whether it depends on where elements are at rest.
  bool depends_on_place() const { return uses("u") || uses("v") || uses("w"); }
};

/// The constant, part or symbol of this name; null without one.
template <class Named>
const Named* find_named(const std::vector<Named>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &Named::name);
  return found == all.end() ? nullptr : &*found;
}

/// Parses the text and appends it as a part whose names, number of arguments and dimensions are checked.
/// Throws Fault.
void append_part(Law& law, const std::string& name, const std::string& text, bool is_energy);

}  // namespace drape::formula
