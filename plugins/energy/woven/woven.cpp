#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/formulas/membrane_formula.h"

namespace drape {

/// St. Venant–Kirchhoff's density with the material's stiffness along warp, weft and in shear [J/m²].
struct WovenLaw : FormulaLaw<> {
  OrthotropicStiffness c;

  WovenLaw() : WovenLaw({}, Material()) {}
  WovenLaw(const NoParameters& none, const Material& material)
      : FormulaLaw<>(none, material), c(membrane_stiffness(material)) {}

  template <class S, class T>
  S operator()(const S& g11, const S& g22, const S& g12, const S&, const S&, const AreaRatio<S>&, const T&,
               const T&, const T&, const T&) const {
    return 0.5 * (c.c11 * (g11 * g11) + c.c22 * (g22 * g22)) + c.c12 * (g11 * g22) + 2 * c.c66 * (g12 * g12);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::MembraneFormula<drape::WovenLaw>>(
      "woven", "Membrane of woven cloth: stiffness along warp and weft, and in shear, as measured.");
}
