#pragma once

#include <cmath>

#include "core/kernel/interfaces/material.h"

namespace drape {

/// The coefficient k = E_bend d³ / (24 (1 - ν²)) [J] of every isotropic bending energy: half a plate's
/// bending stiffness (docs/theory/method.md, section 5).
inline double bending_stiffness(const Material& material) {
  const double nu = material.poisson_ratio;
  return material.mean_bending_modulus() * std::pow(material.thickness, 3) / (24 * (1 - nu * nu));
}

}  // namespace drape
