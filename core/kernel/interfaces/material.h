#pragma once

#include <optional>

namespace drape {

/// What estimates of a cloth's weight take for gravity [m/s²].
inline constexpr double standard_gravity = 9.81;

/// A cloth material. Moduli are Young's moduli of the bulk, as in the supplement's Table 2. Stiffnesses by
/// direction, as laboratories measure them on strips, replace the modulus: laws with directions read them
/// (core/numerics/elements/orthotropic_stiffness.h), isotropic ones their geometric mean.
struct Material {
  double density = 472.6;                                ///< ρ [kg/m³]
  double thickness = 3.18e-4;                            ///< d [m]
  double membrane_modulus = 8e4;                         ///< E_mem [Pa]
  double bending_modulus = 8e4;                          ///< E_bend [Pa]
  double poisson_ratio = 0.243;                          ///< ν [1]
  std::optional<double> warp_stiffness, weft_stiffness;  ///< in stretching [N/m]
  std::optional<double> shear_stiffness;                 ///< [N/m]
  std::optional<double> warp_bending, weft_bending;      ///< rigidity of a strip along warp or weft [N·m]
  std::optional<double> bias_bending;                    ///< of a strip at 45° [N·m]
  double bending_hysteresis = 0;                         ///< 2HB of KES-FB2 [N]

  bool operator==(const Material&) const = default;

  /// Mass per area, ρ d [kg/m²].
  double area_density() const { return density * thickness; }
  /// Young's modulus of an isotropic membrane that stands for this material [Pa].
  double mean_membrane_modulus() const;
  /// Young's modulus of an isotropic plate that stands for this material [Pa].
  double mean_bending_modulus() const;
};

}  // namespace drape
