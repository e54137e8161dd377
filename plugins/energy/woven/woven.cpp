#include <stdexcept>
#include <string>
#include <vector>

#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/formulas/membrane_formula.h"

namespace drape {

/// Tension curves of a laboratory.
struct TensionCurves {
  std::vector<double> warp_tension, weft_tension;  ///< strain [1], force per width [N/m], strain, …

  template <class Self>
  static void declare(Declaration<Self>& d) {
    const auto curve = [&](const char* name, std::vector<double> TensionCurves::*member,
                           const char* description) {
      d.add(name, member, description).between(0, bounds::largest_modulus);
    };
    curve(
        "warp_tension", &TensionCurves::warp_tension,
        "tension curve of a strip along warp in place of `warp_stiffness`: strain, force per width [N/m], by "
        "turns, both rising");
    curve("weft_tension", &TensionCurves::weft_tension, "the same along weft");
  }
};

/// A tension curve as second Piola–Kirchhoff stress S by Green strain g: linear from point to point, and on
/// beyond the last. Its energy is ½ stiffness g² + Σ ½ bend (g - g_k)² over the points g_k < g.
struct TensionCurve {
  struct Bend {
    double strain, stiffness;  ///< g_k [1], added from there on [N/m]
  };
  double stiffness = 0;  ///< of small strains [N/m]
  std::vector<Bend> bends;

  /// `points` as in TensionCurves. Throws std::runtime_error that names a point out of order.
  static TensionCurve of(const char* key, const std::vector<double>& points) {
    TensionCurve curve;
    if (points.size() % 2 != 0)
      throw std::runtime_error("\"" + std::string(key) +
                               "\" has an odd number of values; give strain and force of each point");
    double g = 0, stress = 0, last = 0;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      const double strain = points[i], stretch = 1 + strain, own_g = strain * (1 + strain / 2),
                   own_stress = points[i + 1] / stretch;
      if (!(own_g > g) || !(own_stress > stress))
        throw std::runtime_error("\"" + std::string(key) + "\": point " + std::to_string(i / 2 + 1) +
                                 (own_g > g ? ": force over stretch" : ": strain") +
                                 " does not rise from the point before");
      const double slope = (own_stress - stress) / (own_g - g);
      if (i == 0)
        curve.stiffness = slope;
      else
        curve.bends.push_back({g, slope - last});
      g = own_g, stress = own_stress, last = slope;
    }
    return curve;
  }

  /// The energy of the bends by the strain [J/m²].
  template <class S>
  S beyond(const S& g) const {
    S sum(0.0);
    for (const Bend& bend : bends) {
      const S over = max(g - bend.strain, S(0.0));
      sum = sum + 0.5 * bend.stiffness * (over * over);
    }
    return sum;
  }
};

/// St. Venant–Kirchhoff's density with the material's stiffness along warp, weft and in shear [J/m²], and
/// what tension curves add: in a strip that contracts freely they are those that were measured.
struct WovenLaw : FormulaLaw<TensionCurves> {
  TensionCurve warp, weft;
  OrthotropicStiffness c;

  WovenLaw() : WovenLaw({}, Material()) {}
  WovenLaw(const TensionCurves& curves, Material material)
      : FormulaLaw(curves, material),
        warp(TensionCurve::of("warp_tension", curves.warp_tension)),
        weft(TensionCurve::of("weft_tension", curves.weft_tension)) {
    if (warp.stiffness > 0) material.warp_stiffness = warp.stiffness;
    if (weft.stiffness > 0) material.weft_stiffness = weft.stiffness;
    c = membrane_stiffness(material);
  }

  template <class S, class T>
  S operator()(const S& g11, const S& g22, const S& g12, const S&, const S&, const AreaRatio<S>&, const T&,
               const T&, const T&, const T&) const {
    const S straight =
        0.5 * (c.c11 * (g11 * g11) + c.c22 * (g22 * g22)) + c.c12 * (g11 * g22) + 2 * c.c66 * (g12 * g12);
    return warp.bends.empty() && weft.bends.empty() ? straight
                                                    : straight + warp.beyond(g11) + weft.beyond(g22);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::MembraneFormula<drape::WovenLaw>>(
      "woven", "Membrane of woven cloth: stiffness along warp and weft, and in shear, as measured.");
}
