#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/kernel/files/string_utils.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {
namespace {

using Powers = std::array<double, 3>;  // m, kg, s

/// Units by their names, which a formula's constants may have; the first one of a dimension is how it is
/// shown.
const std::vector<std::pair<std::string, Powers>> units = {
    {"1", {0, 0, 0}},  {"m", {1, 0, 0}},    {"kg", {0, 1, 0}}, {"s", {0, 0, 1}},   {"J", {2, 1, -2}},
    {"N", {1, 1, -2}}, {"Pa", {-1, 1, -2}}, {"W", {2, 1, -3}}, {"Hz", {0, 0, -1}}, {"rad", {0, 0, 0}},
};
/// Quotients that are more readable than products of powers.
const std::vector<std::pair<std::string, Powers>> quotients = {
    {"m²", {2, 0, 0}},     {"m³", {3, 0, 0}},     {"1/m", {-1, 0, 0}},   {"1/m²", {-2, 0, 0}},
    {"J/m²", {0, 1, -2}},  {"J/m³", {-1, 1, -2}}, {"kg/m²", {-2, 1, 0}}, {"kg/m³", {-3, 1, 0}},
    {"m/s", {1, 0, -1}},   {"m/s²", {1, 0, -2}},  {"N/m³", {-2, 1, -2}}, {"1/s", {0, 0, -1}},
    {"Pa/m", {-2, 1, -2}}, {"J m", {3, 1, -2}},   {"1/s²", {0, 0, -2}},
};

bool are_close(double a, double b) { return std::abs(a - b) < 1e-9; }

/// "², ³, ⁻" and the other raised characters as "^2", "^3", "^-".
std::string lowered(std::string text) {
  static const std::vector<std::pair<std::string, std::string>> raised = {{"⁻", "-"}, {"¹", "1"}, {"²", "2"},
                                                                          {"³", "3"}, {"⁴", "4"}, {"·", " "}};
  for (const auto& [from, to] : raised)
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from)) {
      const bool first = to != " " && (at == 0 || (text[at - 1] != '-' && text[at - 1] != '^'));
      text.replace(at, from.size(), (first ? "^" : "") + to);
    }
  return text;
}

const std::vector<Symbol> of_material = {
    {"E", "Pa", "Young's modulus of the membrane", [](const auto& m) { return m.E; }},
    {"E_bend", "Pa", "Young's modulus in bending", [](const auto& m) { return m.E_bend; }},
    {"nu", "1", "Poisson's ratio", [](const auto& m) { return m.nu; }},
    {"mu", "Pa", "Lamé's constant μ = E / (2 (1 + ν))", [](const auto& m) { return m.mu; }},
    {"lambda", "Pa", "Lamé's constant of plane stress, λ = E ν / (1 - ν²)",
     [](const auto& m) { return m.lambda; }},
    {"k", "J", "bending stiffness E_bend d³ / (24 (1 - ν²)), half a plate's",
     [](const auto& m) { return m.k; }},
    {"rho", "kg/m³", "density", [](const auto& m) { return m.rho; }},
    {"thickness", "m", "thickness d", [](const auto& m) { return m.thickness; }},
    {"pi", "1", "π", [](const auto& m) { return m.pi; }},
};

std::vector<Symbol> with_material(std::vector<Symbol> own) {
  own.insert(own.end(), of_material.begin(), of_material.end());
  return own;
}

}  // namespace

Dimension operator*(const Dimension& a, const Dimension& b) {
  Dimension c;
  for (int i = 0; i < 3; ++i) c.powers[i] = a.powers[i] + b.powers[i];
  return c;
}

Dimension Dimension::to(double exponent) const {
  Dimension c;
  for (int i = 0; i < 3; ++i) c.powers[i] = exponent * powers[i];
  return c;
}

bool Dimension::operator==(const Dimension& other) const {
  return std::equal(powers.begin(), powers.end(), other.powers.begin(), are_close);
}

std::string Dimension::text() const {
  for (const auto* list : {&units, &quotients})
    for (const auto& [name, of] : *list)
      if (Dimension{of} == *this) return name;
  std::string text;
  for (int i = 0; i < 3; ++i) {
    if (are_close(powers[i], 0)) continue;
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, std::round(powers[i] * 1e6) / 1e6).ptr;
    text += (text.empty() ? "" : " ") + units[1 + i].first;
    if (!are_close(powers[i], 1)) text += "^" + std::string(digits, end);
  }
  return text;
}

std::optional<Dimension> dimension_of(const std::string& unit) {
  const std::string text = lowered(unit);
  Dimension whole;
  double sign = 1;       // -1 behind "/"
  bool expects = true;   // a unit, at the beginning or behind "*", "/" or "("
  bool inside = false;   // parentheses
  bool divided = false;  // what "/" divides by has ended
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (expects && std::string_view("*/)").find(c) != std::string_view::npos) return std::nullopt;
    if (c == '/' && (sign < 0 || inside)) return std::nullopt;  // a/b/c, (a/b c): ambiguous to readers
    if (c == '(' || c == ')') {
      if (inside == (c == '(')) return std::nullopt;  // nested, or not opened
      inside = !inside;
    }
    if (c == ')') divided = sign < 0;
    if (c == '/') sign = -1;
    if (c == '/' || c == '*' || c == '(') expects = true;
    if (std::string_view(" */()").find(c) != std::string_view::npos) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && (std::isalpha(static_cast<unsigned char>(text[end])) || text[end] == '1'))
      ++end;
    const auto found =
        std::ranges::find(units, text.substr(at, end - at), &decltype(units)::value_type::first);
    if (divided || found == units.end()) return std::nullopt;  // a/b c is ambiguous, too
    double exponent = 1;
    if (end < text.size() && text[end] == '^') {
      const auto [rest, error] = std::from_chars(text.data() + end + 1, text.data() + text.size(), exponent);
      if (error != std::errc() || !(std::abs(exponent) <= 12)) return std::nullopt;
      end = static_cast<std::size_t>(rest - text.data());
    }
    whole = whole * Dimension{found->second}.to(sign * exponent);
    expects = false;
    divided = sign < 0 && !inside;
    at = end;
  }
  return expects || inside ? std::nullopt : std::optional(whole);
}

std::string name_of(ElementKind kind) {
  return kind == ElementKind::triangle ? "triangle" : kind == ElementKind::hinge ? "hinge" : "vertex";
}

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

const std::vector<Function>& functions() {
  using U = Function::Units;
  static const std::vector<Function> all = {
      {"+", 2, 2, U::equal, ""},
      {"-", 2, 2, U::equal, ""},
      {"-", 1, 1, U::equal, ""},
      {"*", 2, 2, U::product, ""},
      {"/", 2, 2, U::quotient, ""},
      {"^", 2, 2, U::power, ""},
      {"<", 2, 2, U::reads, ""},
      {"<=", 2, 2, U::reads, ""},
      {">", 2, 2, U::reads, ""},
      {">=", 2, 2, U::reads, ""},
      {"==", 2, 2, U::reads, ""},
      {"!=", 2, 2, U::reads, ""},
      {"and", 2, 2, U::logical, ""},
      {"or", 2, 2, U::logical, ""},
      {"not", 1, 1, U::logical, ""},
      {"pow", 2, 2, U::power, "pow(x, y) is x^y"},
      {"sqrt", 1, 1, U::root, "square root"},
      {"exp", 1, 1, U::none, "e^x"},
      {"expm1", 1, 1, U::none, "e^x - 1, to all digits near 0"},
      {"log", 1, 1, U::none, "natural logarithm"},
      {"log1p", 1, 1, U::none, "log(1 + x), to all digits near 0"},
      {"sin", 1, 1, U::none, "of an angle in radians"},
      {"cos", 1, 1, U::none, "of an angle in radians"},
      {"tan", 1, 1, U::none, "of an angle in radians"},
      {"asin", 1, 1, U::none, "in [-π/2, π/2]"},
      {"acos", 1, 1, U::none, "in [0, π]"},
      {"atan", 1, 1, U::none, "in (-π/2, π/2)"},
      {"atan2", 2, 2, U::angle, "angle of (x, y), written atan2(y, x)"},
      {"sinh", 1, 1, U::none, "hyperbolic sine"},
      {"cosh", 1, 1, U::none, "hyperbolic cosine"},
      {"tanh", 1, 1, U::none, "hyperbolic tangent"},
      {"abs", 1, 1, U::equal, "absolute value; its derivative at 0 is 0"},
      {"sign", 1, 1, U::angle, "-1, 0 or 1"},
      {"min", 2, 8, U::equal, "smallest of its arguments; derivatives are those of the first that is it"},
      {"max", 2, 8, U::equal, "largest of its arguments; derivatives are those of the first that is it"},
      {"if", 3, 3, U::choice,
       "if(condition, a, b): a where the condition holds, else b; derivatives are those of the chosen one"},
  };
  return all;
}

const Function* find_function(const std::string& name, std::size_t arguments) {
  const Function* found = nullptr;
  for (const Function& f : functions()) {
    if (f.name != name) continue;
    const auto count = static_cast<int>(arguments);
    if (count >= f.least && count <= f.most) return &f;
    found = &f;
  }
  return found;
}

std::string vocabulary() {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& unit, const std::string& description) {
    text += "    " + padded(name, 10) + padded(unit == "1" ? "" : unit, 8) + description + "\n";
  };
  for (const ElementKind kind : element_kinds) {
    text += "  per: " + name_of(kind) + "\n";
    for (const Symbol& s : symbols_of(kind))
      if (!s.value) line(s.name, s.unit, s.description);
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
