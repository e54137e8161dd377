#pragma once

#include <string>
#include <vector>

namespace drape {

/// Argument of a parameter struct's `static void declare(Declaration<Self>&)`. Whoever uses `declare`
/// includes parameters.h.
///
///     struct NewtonParameters {
///       double step_size = 0.5;
///       static void declare(Declaration<NewtonParameters>& d) {
///         d.add("step_size", &NewtonParameters::step_size, "…").unit("s").above(0).source("…");
///       }
///     };
///
/// Members may be double, int, bool, std::string, std::optional of those, std::vector of double, int or
/// std::string, Eigen::Vector2d/3d, enums with words (`add_choice`), another declared struct
/// (`add_section`), a vector of one (`add_sections`), numbers that the config names (NamedConstants), or a
/// ConfigNode or a vector of them for a plugin that is made later; name its kind with `.plugin("energy")`.
template <class Struct>
class Declaration;

/// The parameters of a plugin without any.
struct NoParameters {
  static void declare(Declaration<NoParameters>&) {}
};

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
