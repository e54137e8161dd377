#pragma once

#include <memory>
#include <optional>

#include "core/numerics/elements/jet_functions.h"
#include "core/numerics/elements/vertex_energy.h"
#include "core/numerics/formulas/formula_law.h"
#include "core/numerics/formulas/formula_properties.h"

namespace drape {

/// A vertex's energy [J] that a Law returns, for VertexEnergy.
template <class Law>
struct VertexFormulaKernel {
  Law law;

  template <class T>
  T value(const T* x, const T* rest) const {
    return jet(x, rest).value;
  }
  template <class T>
  T gradient(const T* x, const T* rest, T* g) const {
    const Jet<3, T> w = jet(x, rest);
    for (int c = 0; c < 3; ++c) g[c] = w.first[c];
    return w.value;
  }
  template <class T>
  void hessian(const T* x, const T* rest, Eigen::Matrix<T, 3, 3>& h) const {
    const Jet<3, T> w = jet(x, rest);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i <= j; ++i) h(i, j) = w.second_by(i, j);
  }

 private:
  template <class T>
  Jet<3, T> jet(const T* x, const T* rest) const {
    using J = Jet<3, T>;
    return law(J::variable(x[0], 0), J::variable(x[1], 1), J::variable(x[2], 2), rest[0], rest[1], rest[2],
               rest[3], rest[4]);
  }
};

/// The energy that DRAPE_VERTEX registers: a load, unless its parameters have a static `role`. One that is
/// linear in the position is bound as constant forces.
template <class Law>
class VertexFormula final : public Energy {
 public:
  using Parameters = typename Law::Parameters;
  DRAPE_SYMBOLS((x), (y), (z), (u), (v), (w), (area), (mass));

  explicit VertexFormula(const Parameters& parameters) : p_(parameters) {}
  EnergyRole role() const override { return role_or<Parameters>(EnergyRole::external); }

  std::optional<double> midpoint_factor() const override {
    const Trace all = trace(Law(p_, Material()));
    if (all.reads || all.degree > 1) return std::nullopt;
    return sampled_midpoint_factor([&](const Level& level) { return bind(level, Material()); });
  }

  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    using Kernel = VertexFormulaKernel<Law>;
    const Law law(p_, material);
    auto bound = std::make_unique<VertexEnergy<Kernel>>(level, material, Kernel{law});
    if (trace(law).degree > 1) return bound;
    return as_linear(std::move(bound), level);
  }

 private:
  static Trace trace(const Law& law) {
    const Trace x(1, 0), place(0, Trace::place), size;
    return law(x, x, x, place, place, place, size, size);
  }

  Parameters p_;
};

}  // namespace drape
