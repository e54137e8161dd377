#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plugins/energy/formula/symbols.h"
#include "plugins/energy/formula/syntax.h"

namespace drape::formula {

/// A number that the config names.
struct Constant {
  std::string name;
  double value = 0;
  std::string unit;  ///< SI; empty: it fits any dimension
};

/// A named formula: a sub-expression, or the energy itself.
struct Part {
  std::string name;  ///< of a sub-expression, or "density" or "energy"
  std::string text;
  Tree tree;
  bool is_condition = false;
  std::optional<Dimension> dimension;  ///< without one it fits any
  bool has_units = false;              ///< whether a quantity with a unit is in it
};

/// An energy by formulas, before the material is known.
struct Law {
  ElementKind kind = ElementKind::triangle;
  std::vector<Constant> constants;
  std::vector<Part> parts;  ///< each may use those before; the last is the energy
  bool per_area = false;    ///< the energy is one of a unit of rest area [J/m²]

  /// Whether the energy or what it uses has the symbol in it.
  bool uses(const std::string& symbol) const;
  /// Whether it depends on where elements are at rest.
  bool depends_on_place() const { return uses("u") || uses("v") || uses("w"); }
};

/// Parses the text and appends it as a part whose names, number of arguments and dimensions are checked.
/// Throws Fault.
void append_part(Law& law, const std::string& name, const std::string& text, bool is_energy);

/// The line of the text that a fault is in, and a caret below its place.
std::string with_caret(const std::string& text, const Fault& fault);

}  // namespace drape::formula
