#include "plugins/energy/formula/symbols.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/kernel/files/string_utils.h"
#include "core/numerics/formulas/formula_law.h"
#include "plugins/energy/formula/functions.h"

namespace drape::formula {
namespace {

const std::vector<Symbol> of_material = {
    {"E", "Pa", "Young's modulus of the membrane"},
    {"E_bend", "Pa", "Young's modulus in bending"},
    {"nu", "1", "Poisson's ratio"},
    {"mu", "Pa", "Lamé's constant μ = E / (2 (1 + ν))"},
    {"lambda", "Pa", "Lamé's constant of plane stress, λ = E ν / (1 - ν²)"},
    {"k", "J", "bending stiffness E_bend d³ / (24 (1 - ν²)), half a plate's"},
    {"rho", "kg/m³", "density"},
    {"thickness", "m", "thickness d"},
    {"pi", "1", "π"},
};

std::vector<Symbol> with_material(std::vector<Symbol> own) {
  own.insert(own.end(), of_material.begin(), of_material.end());
  return own;
}

}  // namespace

const std::vector<Symbol>& symbols_of(ElementKind kind) {
  static const std::vector<Symbol> triangle = with_material({
      {"g11", "1", "Green strain along the material's first axis (warp)"},
      {"g22", "1", "Green strain along the second axis (weft)"},
      {"g12", "1", "Green shear strain, half the engineering shear"},
      {"s1", "1", "larger principal stretch, 1 at rest"},
      {"s2", "1", "smaller principal stretch"},
      {"J", "1", "ratio of area to rest area, s1 s2"},
      {"area", "m²", "rest area of the triangle"},
      {"u", "m", "rest position of its centroid, x"},
      {"v", "m", "rest position of its centroid, y"},
      {"w", "m", "rest position of its centroid, z"},
  });
  static const std::vector<Symbol> hinge = with_material({
      {"theta", "rad", "angle between the normals of the two triangles, 0 where flat"},
      {"rest", "rad", "theta of the rest shape"},
      {"bend", "rad", "theta - rest, by the shorter turn"},
      {"length", "m", "rest length of the edge"},
      {"h1", "m", "rest height of the first triangle over the edge"},
      {"h2", "m", "rest height of the second"},
      {"area", "m²", "rest area of both triangles"},
      {"u", "m", "rest position of the edge's midpoint, x"},
      {"v", "m", "rest position of the edge's midpoint, y"},
      {"w", "m", "rest position of the edge's midpoint, z"},
  });
  static const std::vector<Symbol> vertex = with_material({
      {"x", "m", "position"},
      {"y", "m", "position"},
      {"z", "m", "position, up"},
      {"u", "m", "rest position, x"},
      {"v", "m", "rest position, y"},
      {"w", "m", "rest position, z"},
      {"area", "m²", "a third of the rest area of its triangles"},
      {"mass", "kg", "mass of that area"},
  });
  return kind == ElementKind::triangle ? triangle : kind == ElementKind::hinge ? hinge : vertex;
}

bool is_of_material(const std::string& symbol) {
  return std::any_of(of_material.begin(), of_material.end(),
                     [&](const Symbol& s) { return s.name == symbol; });
}

double material_value(const std::string& symbol, const Material& m) {
  const MaterialSymbols s(m);
  for (const auto& [name, value] :
       {std::pair{"E", s.E}, std::pair{"E_bend", s.E_bend}, std::pair{"nu", s.nu}, std::pair{"mu", s.mu},
        std::pair{"lambda", s.lambda}, std::pair{"k", s.k}, std::pair{"rho", s.rho},
        std::pair{"thickness", s.thickness}, std::pair{"pi", s.pi}})
    if (symbol == name) return value;
  throw std::logic_error("no material symbol " + symbol);
}

std::string name_of(ElementKind kind) {
  return kind == ElementKind::triangle ? "triangle" : kind == ElementKind::hinge ? "hinge" : "vertex";
}

std::string vocabulary() {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& unit, const std::string& description) {
    text += "    " + padded(name, 10) + padded(unit == "1" ? "" : unit, 8) + description + "\n";
  };
  for (const ElementKind kind : {ElementKind::triangle, ElementKind::hinge, ElementKind::vertex}) {
    text += "  per: " + name_of(kind) + "\n";
    for (const Symbol& s : symbols_of(kind))
      if (!is_of_material(s.name)) line(s.name, s.unit, s.description);
  }
  text += "  of the material\n";
  for (const Symbol& s : of_material) line(s.name, s.unit, s.description);
  text += "  functions\n";
  for (const Function& f : functions())
    if (!f.description.empty()) line(f.name, "", f.description);
  text +=
      "  operators, from weak to strong: or, and, not; < <= > >= == !=; + -; * /; sign; ^\n"
      "  A number outside a function's domain, such as log(-1), is an infinite energy: no step goes there.\n";
  return text;
}

}  // namespace drape::formula
