#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/numerics/buckling/buckling_membrane.h"
#include "core/numerics/buckling/buckling_strains.h"
#include "core/numerics/elements/element_energy.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/formulas/formula_law.h"
#include "core/numerics/formulas/formula_properties.h"

namespace drape {

/// A triangle's energy by the density [J/m²] that a Law returns, for ElementEnergy. `rest` has the first five
/// numbers of a MaterialTriangle, or all eight for a law that depends on its place.
template <class Law, int numbers>
struct MembraneFormulaKernel {
  static constexpr int vertices = 3;
  static constexpr bool convex = false;
  using Rest = Eigen::Matrix<double, numbers, 1>;
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  Law law;

  template <class T>
  T value(const Vector<T>* e, const T* rest) const {
    return jet<1>(GreenStrain<T>(e, rest), rest).value;
  }

  template <class T>
  T gradient(const Vector<T>* e, const T* rest, Vector<T>* g) const {
    const GreenStrain<T> s(e, rest);
    const Jet<3, T> w = jet<3>(s, rest);
    StrainDerivatives<T>::gradient(s.f1, s.f2, w.first, rest, g);
    return w.value;
  }

  template <class T>
  void hessian(const Vector<T>* e, const T* rest, Eigen::Matrix<T, 6, 6>& h) const {
    const GreenStrain<T> s(e, rest);
    const Jet<3, T> w = jet<3>(s, rest);
    StrainDerivatives<T>::hessian(s.f1, s.f2, w.first, w.second, rest, h);
  }

 private:
  /// The energy as a function of N strains; a compiler drops the derivatives that nothing reads.
  template <int N, class T>
  Jet<N, T> jet(const GreenStrain<T>& s, const T* rest) const {
    using J = Jet<N, T>;
    const auto variable = [](const T& value, int i) { return i < N ? J::variable(value, i) : J(value); };
    T place[3] = {0.0, 0.0, 0.0};
    for (int i = 5; i < numbers; ++i) place[i - 5] = rest[i];
    const J none(0.0);
    return rest[4] * law(variable(s.g11, 0), variable(s.g22, 1), variable(s.g12, 2), none, none,
                         area_ratio<N>(rounded(s.g11), rounded(s.g22), rounded(s.g12), s.det()), rest[4],
                         place[0], place[1], place[2]);
  }
};

/// An isotropic density by principal stretches, for StretchKernel and BucklingLaw: numbers from the area of
/// MaterialTriangle on.
template <class Law>
struct PrincipalFormula {
  static constexpr int constants = 4;
  static constexpr bool convex = false;
  Law law;

  template <class T>
  PrincipalDerivatives<T> operator()(const T& t1, const T& t2, const T* rest) const {
    using J = Jet<2, T>;
    const J s1 = J::variable(t1, 0), s2 = J::variable(t2, 1), ratio = s1 * s2;
    const J w = rest[0] * law(0.5 * ((s1 - 1.0) * (s1 + 1.0)), 0.5 * ((s2 - 1.0) * (s2 + 1.0)), J(0.0), s1,
                              s2, AreaRatio<J>{ratio, log(ratio)}, rest[0], rest[1], rest[2], rest[3]);
    return {w.value, w.first[0], w.first[1], w.second_by(0, 0), w.second_by(1, 1), w.second_by(0, 1)};
  }
  template <class T>
  T value(const T& s1, const T& s2, const T* rest) const {
    return (*this)(s1, s2, rest).energy;
  }
  template <class T>
  CoupledSlopes<T> slopes(const T& s1, const T& s2, const T* rest) const {
    const PrincipalDerivatives<T> w = (*this)(s1, s2, rest);
    CoupledSlopes<T> slopes;
    slopes.first1 = w.first1, slopes.first2 = w.first2;
    slopes.second1 = w.second1, slopes.second2 = w.second2, slopes.mixed = w.mixed;
    slopes.divide(s1, s2);
    return slopes;
  }
};

/// The energy that DRAPE_MEMBRANE registers: a membrane, unless its parameters have a static `role`.
template <class Law>
class MembraneFormula final : public Energy {
 public:
  using Parameters = typename Law::Parameters;
  DRAPE_SYMBOLS((g11), (g22), (g12), (s1), (s2), (J), (area), (u), (v), (w));

  /// Throws std::runtime_error for a law by strains and stretches at once.
  explicit MembraneFormula(const Parameters& parameters) : p_(parameters) {
    constexpr unsigned both = Trace::strains | Trace::stretches;
    if ((reads(Law(p_, Material())) & both) == both)
      throw std::runtime_error(
          "the formula uses Green strains (g11, g22, g12) and principal stretches (s1, s2): use either, in "
          "two energies if need be");
  }
  EnergyRole role() const override { return role_or<Parameters>(EnergyRole::membrane); }

  // The four triangles have the strains of the whole, and a quarter of its area each.
  std::optional<double> midpoint_factor() const override {
    return is_fixed(Law(p_, Material())) ? std::nullopt : std::optional(1.0);
  }

  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    const Law law(p_, material);
    if (reads(law) & Trace::stretches) {
      const std::vector<MaterialTriangle> triangles = material_triangles(level);
      return bind_stretches(PrincipalFormula<Law>{law}, level,
                            [&](int t) { return Eigen::Vector4d(triangles[t].template tail<4>()); });
    }
    return reads(law) & Trace::place ? bind_with<8>(law, level) : bind_with<5>(law, level);
  }

  std::unique_ptr<BoundEnergy> bind_buckling(const Level& level, const Material& material,
                                             double s) const override {
    const Law law(p_, material);
    const std::vector<MaterialTriangle> triangles = material_triangles(level);
    const auto value = [&](const Eigen::Vector3d& g, const double* place) {
      return energy<double>(law, g, place).value;
    };
    if (!(reads(law) & Trace::stretches) && !is_isotropic(triangles, is_fixed(law), value))
      return bind_buckling_strains(
          [law](const auto& g, const auto* place) { return energy<Pack<native_pack_width>>(law, g, place); },
          triangles, level, s);
    return bind_buckling_membrane(PrincipalFormula<Law>{law}, triangles, level, s);
  }

 private:
  static unsigned reads(const Law& law) {
    const Trace strain(1, Trace::strains), stretch(1, Trace::stretches), ratio(1, 0), place(0, Trace::place),
        size(0, Trace::size);
    return law(strain, strain, strain, stretch, stretch, AreaRatio<Trace>{ratio, ratio}, size, place, place,
               place)
        .reads;
  }

  /// Whether the density depends on where a triangle is at rest, or how large.
  static bool is_fixed(const Law& law) { return (reads(law) & (Trace::place | Trace::size)) != 0; }

  template <int numbers>
  std::unique_ptr<BoundEnergy> bind_with(const Law& law, const Level& level) const {
    using Kernel = MembraneFormulaKernel<Law, numbers>;
    std::vector<typename Kernel::Rest> rest;
    for (const MaterialTriangle& triangle : material_triangles(level))
      rest.emplace_back(triangle.template head<numbers>());
    return std::make_unique<ElementEnergy<Kernel>>(level.rest.triangles, rest, level.triangle_order,
                                                   Kernel{law});
  }

  /// A StrainLaw.
  template <class T>
  [[gnu::flatten]] static Jet<3, T> energy(const Law& law, const Eigen::Matrix<T, 3, 1>& g, const T* place) {
    using J = Jet<3, T>;
    const T det = (1.0 + 2.0 * g[0]) * (1.0 + 2.0 * g[1]) - 4.0 * (g[2] * g[2]);
    const J none(0.0);
    return place[0] * law(J::variable(g[0], 0), J::variable(g[1], 1), J::variable(g[2], 2), none, none,
                          area_ratio<3>(g[0], g[1], g[2], det), place[0], place[1], place[2], place[3]);
  }

  Parameters p_;
};

}  // namespace drape
