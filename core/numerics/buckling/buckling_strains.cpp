#include "core/numerics/buckling/buckling_strains.h"

#include <limits>

#include "core/numerics/buckling/buckling_membrane.h"
#include "core/numerics/buckling/one_direction.h"
#include "core/numerics/elements/element_energy.h"

namespace drape {
namespace {

using Eigen::Vector3d;
using P = Pack<native_pack_width>;
using Mask = P::Mask;
using Strains = Eigen::Matrix<P, 3, 1>;

/// The kernel of ElementEnergy, for packs. Rest is a MaterialTriangle, its slack strains, the energy there,
/// and s.
struct BucklingStrains {
  static constexpr int vertices = 3;
  static constexpr bool convex = false;
  using Rest = Eigen::Matrix<double, 13, 1>;
  using Vector = Eigen::Matrix<P, 3, 1>;

  StrainLaw law;

  P value(const Vector* e, const P* rest) const {
    return relaxed(GreenStrain<P>(e, rest), rest + 4, false).value;
  }
  P gradient(const Vector* e, const P* rest, Vector* g) const {
    const GreenStrain<P> strain(e, rest);
    const Jet<3, P> w = relaxed(strain, rest + 4, true);
    StrainDerivatives<P>::gradient(strain.f1, strain.f2, w.first, rest, g);
    return w.value;
  }
  void hessian(const Vector* e, const P* rest, Eigen::Matrix<P, 6, 6>& h) const {
    const GreenStrain<P> strain(e, rest);
    const Jet<3, P> w = relaxed(strain, rest + 4, true);
    StrainDerivatives<P>::hessian(strain.f1, strain.f2, w.first, w.second, rest, h);
  }

 private:
  static Mask positive(const P& a11, const P& a22, const P& a12) {
    return (a11 + a22 >= 0.0) & (a11 * a22 - a12 * a12 >= 0.0);
  }

  [[gnu::noinline]] Jet<3, P> relaxed(const GreenStrain<P>& strain, const P* place, bool derivatives) const {
    const Strains g(strain.g11, strain.g22, strain.g12);
    const P s = place[8];
    const Jet<3, P> plain = law(g, place);
    const Mask finite = abs(plain.value) <= std::numeric_limits<double>::max();
    const Mask compressed = finite & !positive(plain.first[0] + s, plain.first[1] + s, 0.5 * plain.first[2]);
    if (!any(compressed)) return plain;

    // Wrinkled in all directions, if the slack strains' metric M lies between C and κ² C.
    const Strains slack(place[4], place[5], place[6]), less = slack - g,
                                                       more = g * P(Buckling<double>::most) - slack;
    const P room = 0.5 * (Buckling<double>::most - 1);
    const Mask in_all =
        positive(less[0], less[1], less[2]) & positive(room + more[0], room + more[1], more[2]);
    Jet<3, P> buckled(place[7] + s * (less[0] + less[1]));
    buckled.first[0] = buckled.first[1] = -s;

    if (const Mask others = compressed & !in_all; any(others)) {
      const OneDirection one(law, g, place, s, plain, others);
      buckled = select(one.found(), one.energy(derivatives), buckled);
      const Mask left = others & !one.found();
      for (int i = 0; any(left) && i < native_pack_width; ++i)
        if (left[i]) set_alone(i, g, place, derivatives, buckled);
    }
    return select(compressed,
                  (1 - Buckling<double>::remainder) * buckled + Buckling<double>::remainder * plain, plain);
  }

  void set_alone(int i, const Strains& g, const P* place, bool derivatives, Jet<3, P>& buckled) const {
    const Vector3d own(g[0][i], g[1][i], g[2][i]);
    const double own_place[] = {place[0][i], place[1][i], place[2][i], place[3][i]};
    const Jet<3, double> w = wrinkled(law, own, own_place, place[8][i], derivatives);
    buckled.value.v[i] = w.value;
    for (int k = 0; k < 3; ++k) buckled.first[k].v[i] = w.first[k];
    for (int k = 0; k < 6; ++k) buckled.second[k].v[i] = w.second[k];
  }
};

}  // namespace

std::unique_ptr<BoundEnergy> bind_buckling_strains(const StrainLaw& law,
                                                   const std::vector<MaterialTriangle>& triangles,
                                                   const Level& level, double s) {
  std::vector<BucklingStrains::Rest> rest;
  for (int t = 0; t < std::ssize(triangles); ++t) {
    const double *place = triangles[t].data() + 4, own = s * level.bound_factor(t);
    const Vector3d slack = slack_strains(law, place, own);
    rest.emplace_back() << triangles[t], slack, energy_of_one(law, slack, place).value, own;
  }
  return std::make_unique<ElementEnergy<BucklingStrains>>(level.rest.triangles, rest, level.triangle_order,
                                                          BucklingStrains{law});
}

}  // namespace drape
