#pragma once

#include <type_traits>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/mesh/grain.h"
#include "core/numerics/model/hessian_assembler.h"
#include "core/numerics/model/objective.h"

inline drape::Positions gradient_of(const drape::BoundEnergy& energy, const drape::Positions& x) {
  drape::Positions g = drape::Positions::Zero(x.rows(), 3);
  energy.add_gradient(x, g);
  return g;
}

inline double value_of(drape::Objective& objective, const drape::Positions& x) {
  drape::Positions g;
  return objective.gradient(x, g);
}

/// The cloth's warp at this angle from x everywhere [degree].
inline drape::Positions warp_at(const drape::TriangleMesh& mesh, double angle) {
  return drape::cut_directions(mesh, drape::GrainAxis::x, angle);
}

/// ∂f/∂x by central differences of fourth order with step h [m]; f is a number or an Eigen vector or matrix,
/// and column (or entry) 3 i + c of the result is its derivative by coordinate c of vertex i.
template <class Function, class State>
Eigen::MatrixXd differences(const Function& f, const State& at_x, double h) {
  typename State::PlainObject x = at_x;
  Eigen::MatrixXd result;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double old = x.data()[i];
    const auto at = [&](double offset) -> Eigen::VectorXd {
      x.data()[i] = old + offset;
      const auto y = f(x);
      if constexpr (std::is_arithmetic_v<decltype(f(x))>)
        return Eigen::VectorXd::Constant(1, y);
      else
        return Eigen::Map<const Eigen::VectorXd>(y.data(), y.size());
    };
    const Eigen::VectorXd column = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    x.data()[i] = old;
    if (i == 0) result.resize(column.size(), x.size());
    result.col(i) = column;
  }
  return result;
}

/// The energy's gradient and Hessian by such differences.
inline Eigen::VectorXd gradient_by_differences(const drape::BoundEnergy& energy, const drape::Positions& x,
                                               double h) {
  return differences([&](const drape::Positions& y) { return energy.value(y); }, x, h).transpose();
}
inline Eigen::MatrixXd hessian_by_differences(const drape::BoundEnergy& energy, const drape::Positions& x,
                                              double h) {
  return differences([&](const drape::Positions& y) { return gradient_of(energy, y); }, x, h);
}

/// n×3 as one column of 3n.
inline Eigen::VectorXd flat(const drape::Positions& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), x.size());
}
