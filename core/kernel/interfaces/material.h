#pragma once

#include "core/kernel/plugin/parameters.h"

namespace drape {

/// What estimates of a cloth's weight take for gravity [m/s²].
inline constexpr double standard_gravity = 9.81;

/// An isotropic cloth material. Moduli are Young's moduli of the bulk, as in the supplement's Table 2.
struct Material {
  double density = 472.6;         ///< ρ [kg/m³]
  double thickness = 3.18e-4;     ///< d [m]
  double membrane_modulus = 8e4;  ///< E_mem [Pa]
  double bending_modulus = 8e4;   ///< E_bend [Pa]
  double poisson_ratio = 0.243;   ///< ν [1]

  static void declare(Declaration<Material>& d);
  bool operator==(const Material&) const = default;

  /// Mass per area, ρ d [kg/m²].
  double area_density() const { return density * thickness; }
};

}  // namespace drape
