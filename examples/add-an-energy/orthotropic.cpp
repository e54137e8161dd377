#include "core/numerics/formulas/energy_formula.h"

DRAPE_PARAMETERS(Orthotropic,  //
                 (warp, 2e3, "N/m", 0, 1e9, "stiffness along warp"),
                 (weft, 5e2, "N/m", 0, 1e9, "stiffness along weft"),
                 (shear, 60, "N/m", 0, 1e9, "stiffness in shear"),
                 (poisson, 0.2, "1", 0, 1, "contraction across"));

DRAPE_MEMBRANE(orthotropic, "Woven cloth: stiff along warp and weft, soft in shear.", Orthotropic) {
  return 0.5 * warp * g11 * g11 + 0.5 * weft * g22 * g22 + poisson * sqrt(warp * weft) * g11 * g22 +
         2 * shear * g12 * g12;
}
