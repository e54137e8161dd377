#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/element_energy.h"
#include "core/numerics/elements/jet_functions.h"
#include "core/numerics/formulas/formula_law.h"
#include "core/numerics/formulas/formula_properties.h"

namespace drape {

/// A hinge at rest: its angle, the edge's length [m], the heights of both triangles [m], their area [m²] and
/// the edge's midpoint [m].
using RestHinge = Eigen::Matrix<double, 8, 1>;

/// The hinges of the level. Throws std::runtime_error for one whose triangle has no area.
std::vector<RestHinge> rest_hinges(const Level& level);

/// A hinge's energy [J] that a Law returns, for ElementEnergy. `rest` has the first five numbers of a
/// RestHinge, or all eight for a law that depends on its place.
template <class Law, int numbers>
struct FoldFormulaKernel {
  static constexpr int vertices = 4;
  static constexpr bool convex = false;
  using Rest = Eigen::Matrix<double, numbers, 1>;
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  Law law;

  template <class T>
  T value(const Vector<T>* x, const T* rest) const {
    return jet(bend_from(rest[0], DihedralAngle<T>(x).angle()), rest).value;
  }

  template <class T>
  T gradient(const Vector<T>* x, const T* rest, Vector<T>* g) const {
    const DihedralAngle<T> dihedral(x);
    const Jet<1, T> w = jet(bend_from(rest[0], dihedral.angle()), rest);
    dihedral.gradient(w.first[0], g);
    return w.value;
  }

  template <class T>
  void hessian(const Vector<T>* x, const T* rest, Eigen::Matrix<T, 9, 9>& h) const {
    hessian(x, rest, h, [](Eigen::Matrix<T, 4, 4>&) {});
  }

  template <class T, class Map>
  void hessian(const Vector<T>* x, const T* rest, Eigen::Matrix<T, 9, 9>& h, const Map& map) const {
    const DihedralAngle<T> dihedral(x);
    const Jet<1, T> w = jet(bend_from(rest[0], dihedral.angle()), rest);
    dihedral.hessian(w.second[0], w.first[0], h, map);
  }

  template <class T>
  Jet<1, T> jet(const T& bend_value, const T* rest) const {
    const auto bend = Jet<1, T>::variable(bend_value, 0);
    T place[3] = {0.0, 0.0, 0.0};
    for (int i = 5; i < numbers; ++i) place[i - 5] = rest[i];
    return law(bend + rest[0], bend, rest[0], rest[1], rest[2], rest[3], rest[4], place[0], place[1],
               place[2]);
  }
};

/// The energy that DRAPE_FOLD registers: a bending energy, unless its parameters have a static `role`.
template <class Law>
class FoldFormula final : public Energy {
 public:
  using Parameters = typename Law::Parameters;
  DRAPE_SYMBOLS((theta), (bend), (rest), (length), (h1), (h2), (area), (u), (v), (w));

  explicit FoldFormula(const Parameters& parameters) : p_(parameters) {}
  EnergyRole role() const override { return role_or<Parameters>(EnergyRole::bending); }

  std::optional<double> midpoint_factor() const override {
    const Law law(p_, Material());
    if (reads_place(law)) return std::nullopt;
    return sampled_midpoint_factor([&](const Level& level) { return bind_with<5>(law, level); });
  }

  double plate_stiffness(const Material& material) const override {
    if (role() != EnergyRole::bending) return 0;
    return fold_plate_stiffness([&](const Level& level) { return bind(level, material); });
  }

  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    const Law law(p_, material);
    return reads_place(law) ? bind_with<8>(law, level) : bind_with<5>(law, level);
  }

 private:
  static bool reads_place(const Law& law) {
    const Trace angle(1, 0), place(0, Trace::place), other;
    return law(angle, angle, other, other, other, other, other, place, place, place).reads != 0;
  }

  template <int numbers>
  static std::unique_ptr<BoundEnergy> bind_with(const Law& law, const Level& level) {
    using Kernel = FoldFormulaKernel<Law, numbers>;
    std::vector<typename Kernel::Rest> rest;
    for (const RestHinge& hinge : rest_hinges(level)) rest.emplace_back(hinge.template head<numbers>());
    return std::make_unique<ElementEnergy<Kernel>>(level.hinges, rest, level.hinge_order, Kernel{law});
  }

  Parameters p_;
};

}  // namespace drape
