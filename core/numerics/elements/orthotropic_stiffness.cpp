#include "core/numerics/elements/orthotropic_stiffness.h"

#include <sstream>
#include <stdexcept>

namespace drape {

namespace {

/// The stiffness in shear that an isotropic material with the mean of the two has.
double isotropic_shear(double warp, double weft, double nu) {
  return std::sqrt(warp * weft) / (2 * (1 + nu));
}

}  // namespace

OrthotropicStiffness OrthotropicStiffness::of_strips(double warp, double weft, double nu, double shear) {
  const double c = 1 / (1 - nu * nu);
  return {c * warp, c * weft, c * nu * std::sqrt(warp * weft), shear};
}

double OrthotropicStiffness::strip(double angle) const {
  const double det = c11 * c22 - c12 * c12, s11 = c22 / det, s22 = c11 / det, s12 = -c12 / det;
  const double c = std::pow(std::cos(angle), 2), s = std::pow(std::sin(angle), 2);
  return 1 / (s11 * c * c + s22 * s * s + (2 * s12 + 1 / c66) * c * s);
}

OrthotropicStiffness membrane_stiffness(const Material& m) {
  const double warp = m.warp_stiffness.value_or(m.membrane_modulus * m.thickness),
               weft = m.weft_stiffness.value_or(warp);
  const double shear = m.shear_stiffness.value_or(isotropic_shear(warp, weft, m.poisson_ratio));
  return OrthotropicStiffness::of_strips(warp, weft, m.poisson_ratio, shear);
}

OrthotropicStiffness plate_stiffness(const Material& m) {
  const double warp = m.warp_bending.value_or(m.bending_modulus * std::pow(m.thickness, 3) / 12),
               weft = m.weft_bending.value_or(warp);
  if (!m.bias_bending)
    return OrthotropicStiffness::of_strips(warp, weft, m.poisson_ratio,
                                           isotropic_shear(warp, weft, m.poisson_ratio));
  const double nu = m.poisson_ratio,
               s66 = 4 / *m.bias_bending - 1 / warp - 1 / weft + 2 * nu / std::sqrt(warp * weft);
  const OrthotropicStiffness plate = OrthotropicStiffness::of_strips(warp, weft, nu, 1 / s66);
  if (plate.c66 > 0 && std::isfinite(plate.c66)) return plate;
  std::ostringstream message;
  message << "bending of the material is not positive definite: with \"bias_bending\" of " << *m.bias_bending
          << " N m against twist it has the eigenvalue " << plate.c66 << " N m; with " << warp
          << " N m along warp and " << weft << " N m along weft, a strip at 45° has less than "
          << 4 / (1 / warp + 1 / weft - 2 * m.poisson_ratio / std::sqrt(warp * weft)) << " N m";
  throw std::runtime_error(message.str());
}

}  // namespace drape
