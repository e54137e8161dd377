#pragma once

#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/numerics/elements/element_energy.h"
#include "core/numerics/elements/jet_functions.h"
#include "core/numerics/elements/rest_hinge.h"
#include "core/numerics/formulas/formula_law.h"
#include "core/numerics/formulas/formula_properties.h"
#include "core/numerics/mesh/seams.h"

namespace drape {

/// What the elements of DRAPE_ELEMENT may be. A struct like these, put into this namespace, is another shape;
/// flat() has the vectors of an element of a sewn cloth at rest, where the shape is one for such a cloth too.
namespace elements {
struct edges {
  static constexpr int vertices = 2;
  static constexpr EnergyRole role = EnergyRole::membrane;
  static Stencils of(const Level& level) { return level.topology.edges; }
  static ElementOrder order(const Level& level) { return ElementOrder::of(of(level), level.rest.vertices); }
  static std::array<Eigen::Vector3d, 1> flat(const Level& level, int e) {
    return {Eigen::Vector3d(rest_length(level.rest, level.topology, e), 0, 0)};
  }
};
struct triangles {
  static constexpr int vertices = 3;
  static constexpr EnergyRole role = EnergyRole::membrane;
  static Stencils of(const Level& level) { return level.rest.triangles; }
  static ElementOrder order(const Level& level) { return level.triangle_order; }
  static std::array<Eigen::Vector3d, 2> flat(const Level& level, int t) {
    const Eigen::Matrix3d x = rest_corners(level.rest, t);
    return {x.col(1) - x.col(0), x.col(2) - x.col(0)};
  }
};
struct hinges {
  static constexpr int vertices = 4;
  static constexpr EnergyRole role = EnergyRole::bending;
  static Stencils of(const Level& level) { return level.hinges; }
  static ElementOrder order(const Level& level) { return level.hinge_order; }
  static std::array<Eigen::Vector3d, 3> flat(const Level& level, int h) { return rest_vectors(level, h); }
};
}  // namespace elements

/// The vectors from an element's first vertex to its others.
template <class T, class Elements>
using Vectors = std::array<Eigen::Matrix<T, 3, 1>, Elements::vertices - 1>;

/// An element's energy [J] that a Law returns, by jets over all coordinates of its vectors, for
/// ElementEnergy.
template <class Law, class Elements>
struct ElementFormulaKernel {
  static constexpr int vertices = Elements::vertices, variables = 3 * (vertices - 1);
  static constexpr bool convex = false;
  using Rest = Eigen::Matrix<double, variables, 1>;  ///< the vectors at rest
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  Law law;

  template <class T>
  T value(const Vector<T>* d, const T* rest) const {
    return jet<1>(d, rest, 0).value;
  }

  /// By three coordinates at a time: an element's Hessian would not fit into the registers.
  template <class T>
  T gradient(const Vector<T>* d, const T* rest, Vector<T>* g) const {
    T energy;
    for (int v = 0; v + 1 < vertices; ++v) {
      const Jet<3, T> w = jet<3>(d, rest, 3 * v);
      for (int c = 0; c < 3; ++c) g[v][c] = w.first[c];
      energy = w.value;
    }
    return energy;
  }

  template <class T>
  void hessian(const Vector<T>* d, const T* rest, Eigen::Matrix<T, variables, variables>& h) const {
    const Jet<variables, T> w = jet<variables>(d, rest, 0);
    for (int j = 0; j < variables; ++j)
      for (int i = 0; i <= j; ++i) h(i, j) = h(j, i) = w.second_by(i, j);
  }

 private:
  /// The energy as a function of N coordinates from the `first` on.
  template <int N, class T>
  Jet<N, T> jet(const Vector<T>* d, const T* rest, int first) const {
    using J = Jet<N, T>;
    Vectors<J, Elements> now;
    Vectors<T, Elements> then;
    for (int i = 0; i < variables; ++i) {
      const int v = i / 3, c = i % 3, variable = i - first;
      now[v][c] = variable >= 0 && variable < N ? J::variable(d[v][c], variable) : J(d[v][c]);
      then[v][c] = rest[i];
    }
    return law(now, then);
  }
};

/// The energy that DRAPE_ELEMENT registers: a membrane or, of hinges, a bending energy, unless its parameters
/// have a static `role`.
template <class Law, class Elements>
class ElementFormula final : public Energy {
 public:
  using Parameters = typename Law::Parameters;

  explicit ElementFormula(const Parameters& parameters) : p_(parameters) {}
  EnergyRole role() const override { return role_or<Parameters>(Elements::role); }

  std::optional<double> midpoint_factor() const override {
    try {
      return sampled_midpoint_factor([&](const Level& level) { return bind(level, Material()); });
    } catch (const std::runtime_error&) {  // the sampled meshes lack vertices that the elements name
      return std::nullopt;
    }
  }

  double plate_stiffness(const Material& material) const override {
    if (role() != EnergyRole::bending) return 0;
    try {
      return fold_plate_stiffness([&](const Level& level) { return bind(level, material); });
    } catch (const std::runtime_error&) {  // as above
      return 0;
    }
  }

  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    using Kernel = ElementFormulaKernel<Law, Elements>;
    const Stencils stencils = Elements::of(level);
    if (stencils.size() > 0 && (stencils.minCoeff() < 0 || stencils.maxCoeff() >= level.vertex_count()))
      throw std::runtime_error("an element has a vertex that level " + std::to_string(level.index) +
                               " does not have");
    const Positions& x = level.rest.vertices;
    std::vector<typename Kernel::Rest> rest(static_cast<std::size_t>(stencils.rows()));
    for (int e = 0; e < stencils.rows(); ++e)
      for (int v = 1; v < Elements::vertices; ++v)
        if (!level.rest.sewing)
          rest[e].template segment<3>(3 * (v - 1)) = x.row(stencils(e, v)) - x.row(stencils(e, 0));
        else if constexpr (requires { Elements::flat(level, e); })
          rest[e].template segment<3>(3 * (v - 1)) = Elements::flat(level, e)[v - 1];
        else
          throw std::runtime_error("its elements have no shape at rest in a cloth of flat pieces");
    return std::make_unique<ElementEnergy<Kernel>>(stencils, rest, Elements::order(level),
                                                   Kernel{Law(p_, material)});
  }

 private:
  Parameters p_;
};

template <class Elements>
struct ElementFormulaOf {
  template <class Law>
  using Energy = ElementFormula<Law, Elements>;
};

}  // namespace drape

template <int N, class T, class Op>
struct Eigen::ScalarBinaryOpTraits<drape::Jet<N, T>, T, Op> {
  using ReturnType = drape::Jet<N, T>;
};
template <int N, class T, class Op>
struct Eigen::ScalarBinaryOpTraits<T, drape::Jet<N, T>, Op> {
  using ReturnType = drape::Jet<N, T>;
};
