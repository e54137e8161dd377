#pragma once

#include <array>
#include <optional>
#include <string>

namespace drape::formula {

/// Powers of metre, kilogram and second.
struct Dimension {
  std::array<double, 3> powers{};

  friend Dimension operator*(const Dimension& a, const Dimension& b);
  friend Dimension operator/(const Dimension& a, const Dimension& b);
  Dimension to(double exponent) const;
  bool is_none() const { return *this == Dimension(); }
  bool operator==(const Dimension& other) const;

  /// As SI units: "J/m²", "m^0.5 kg"; "1" without a dimension.
  std::string text() const;
};

/// The dimension of a unit such as "N/m", "J/m^2", "kg m²/s²", "1" or "rad"; none if it is not one in SI
/// units without prefixes.
std::optional<Dimension> dimension_of(const std::string& unit);

}  // namespace drape::formula
