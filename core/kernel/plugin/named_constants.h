#pragma once

#include <string>
#include <vector>

namespace drape {

/// A number that a config names.
struct NamedConstant {
  std::string name;  ///< letters, digits and underscores, not beginning with a digit
  double value = 0;
  std::string unit;  ///< as written; may be empty
};

/// Numbers that a config names, as in `{warp: {value: 2e3, unit: N/m}, nu: 0.2}`, of the parameter
/// `constants_key`. Each is a key of its plugin: `energies.orthotropic.warp`.
struct NamedConstants {
  std::vector<NamedConstant> all;
};

/// The key of a plugin's section under which its named numbers stand.
inline constexpr const char* constants_key = "constants";

}  // namespace drape
