#include "core/numerics/formulas/energy_formula.h"

struct Orthotropic {
  double warp = 2e3, weft = 5e2, shear = 60, poisson = 0.2;
  static void declare(drape::Declaration<Orthotropic>& d) {
    d.add("warp", &Orthotropic::warp).unit("N/m").at_least(0).at_most(1e9).description("along warp");
    d.add("weft", &Orthotropic::weft).unit("N/m").at_least(0).at_most(1e9).description("along weft");
    d.add("shear", &Orthotropic::shear).unit("N/m").at_least(0).at_most(1e9).description("in shear");
    d.add("poisson", &Orthotropic::poisson).at_least(0).at_most(1).description("contraction across");
  }
};

DRAPE_MEMBRANE(orthotropic, "Woven cloth: stiff along warp and weft, soft in shear.", Orthotropic) {
  return 0.5 * warp * g11 * g11 + 0.5 * weft * g22 * g22 + poisson * sqrt(warp * weft) * g11 * g22 +
         2 * shear * g12 * g12;
}
