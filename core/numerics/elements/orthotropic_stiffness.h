#pragma once

#include <cmath>

#include "core/kernel/interfaces/material.h"

namespace drape {

/// Stiffness of a sheet whose axes are warp (1) and weft (2), against strains or curvatures:
///
///     ½ (c11 e11² + c22 e22²) + c12 e11 e22 + 2 c66 e12²   for each unit of rest area
///
/// A strip along an axis has 1/s11 or 1/s22 of the compliance s, one at 45° 4 / (s11 + s22 + 2 s12 + s66).
struct OrthotropicStiffness {
  double c11, c22, c12, c66;

  /// From the stiffness of strips along warp and weft, ν = √(ν12 ν21) < 1, and c66.
  static OrthotropicStiffness of_strips(double warp, double weft, double nu, double shear);
  /// The stiffness of a strip at an angle to warp [rad], whose sides are free.
  double strip(double angle) const;
};

/// The stiffness of the material as a membrane [N/m].
OrthotropicStiffness membrane_stiffness(const Material& material);

/// The stiffness of the material as a plate [N·m]. Throws std::runtime_error with the eigenvalue if no strip
/// at 45° can be as stiff as `bias_bending`.
OrthotropicStiffness plate_stiffness(const Material& material);

/// The coefficient k = E_bend d³ / (24 (1 - ν²)) [J] of every isotropic bending energy: half a plate's
/// bending stiffness (docs/theory/method.md, section 5).
inline double bending_stiffness(const Material& material) {
  const double nu = material.poisson_ratio;
  return material.mean_bending_modulus() * std::pow(material.thickness, 3) / (24 * (1 - nu * nu));
}

}  // namespace drape
