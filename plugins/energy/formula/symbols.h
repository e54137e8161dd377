#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "plugins/energy/formula/dimension.h"

namespace drape::formula {

/// The kinds of elements that a formula can be about.
enum class ElementKind { triangle, hinge, vertex };

/// Inputs of a program: numbers of an element that change with the state, then numbers of its rest shape.
/// Kinds share the numbers: input 0 of a hinge is not that of a triangle.
enum class TriangleInput { g11, g22, g12, det, s1, s2, area, u, v, w };
enum class HingeInput { bend, rest, length, h1, h2, area, u, v, w };
enum class VertexInput { x, y, z, u, v, w, area, mass };

/// A name that a formula may use.
struct Symbol {
  std::string name;
  std::string unit;         ///< SI
  std::string description;  ///< one phrase
};

/// What a kind offers: first what belongs to the element, then the material's.
const std::vector<Symbol>& symbols_of(ElementKind kind);

/// The value of a symbol of the material; throws std::logic_error for another.
double material_value(const std::string& symbol, const Material& material);
/// Whether the symbol is the material's, the same for all elements.
bool is_of_material(const std::string& symbol);

/// "triangle", "hinge" or "vertex".
std::string name_of(ElementKind kind);

/// What each kind offers and the functions, as text for `drape describe formula`.
std::string vocabulary();

}  // namespace drape::formula
