#include "plugins/energy/formula/dimension.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

namespace drape::formula {
namespace {

using Powers = std::array<double, 3>;  // m, kg, s

/// Units by their names; the first one of a dimension is how it is shown.
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

bool same(double a, double b) { return std::abs(a - b) < 1e-9; }

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

}  // namespace

Dimension operator*(const Dimension& a, const Dimension& b) {
  Dimension c;
  for (int i = 0; i < 3; ++i) c.powers[i] = a.powers[i] + b.powers[i];
  return c;
}

Dimension operator/(const Dimension& a, const Dimension& b) { return a * b.to(-1); }

Dimension Dimension::to(double exponent) const {
  Dimension c;
  for (int i = 0; i < 3; ++i) c.powers[i] = exponent * powers[i];
  return c;
}

bool Dimension::operator==(const Dimension& other) const {
  return std::equal(powers.begin(), powers.end(), other.powers.begin(), same);
}

std::string Dimension::text() const {
  for (const auto* list : {&units, &quotients})
    for (const auto& [name, of] : *list)
      if (Dimension{of} == *this) return name;
  std::string text;
  for (int i = 0; i < 3; ++i) {
    if (same(powers[i], 0)) continue;
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, std::round(powers[i] * 1e6) / 1e6).ptr;
    text += (text.empty() ? "" : " ") + units[1 + i].first;
    if (!same(powers[i], 1)) text += "^" + std::string(digits, end);
  }
  return text;
}

std::optional<Dimension> dimension_of(const std::string& unit) {
  const std::string text = lowered(unit);
  Dimension whole;
  double sign = 1;  // -1 behind "/"
  bool expects = true;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ' || text[at] == '*') {
      expects = expects || text[at] == '*';
      ++at;
      continue;
    }
    if (text[at] == '/') {
      if (sign < 0 || at == 0) return std::nullopt;  // a/b/c: ambiguous to readers
      sign = -1, expects = true, ++at;
      continue;
    }
    if (text[at] == '(' || text[at] == ')') {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && (std::isalpha(static_cast<unsigned char>(text[end])) || text[end] == '1'))
      ++end;
    const std::string name = text.substr(at, end - at);
    const auto found =
        std::find_if(units.begin(), units.end(), [&](const auto& u) { return u.first == name; });
    if (found == units.end()) return std::nullopt;
    double exponent = 1;
    if (end < text.size() && text[end] == '^') {
      const auto [rest, error] = std::from_chars(text.data() + end + 1, text.data() + text.size(), exponent);
      if (error != std::errc() || !(std::abs(exponent) <= 12)) return std::nullopt;
      end = static_cast<std::size_t>(rest - text.data());
    }
    whole = whole * Dimension{found->second}.to(sign * exponent);
    expects = false;
    at = end;
  }
  return expects ? std::nullopt : std::optional(whole);
}

}  // namespace drape::formula
