#include "core/numerics/model/derivative_check.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/kernel/files/number_text.h"
#include "core/numerics/model/hessian_assembler.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"

namespace drape {

namespace {

/// Σ_k weight_k f(x + offset_k h) / (12 h), for central differences of fourth order.
constexpr double offsets[] = {-2, -1, 1, 2}, weights[] = {1, -8, 8, -1};

void require_finite(bool finite, const std::string& what, Eigen::Index coordinate) {
  if (!finite)
    throw std::runtime_error(what + " not finite near x, where vertex " + std::to_string(coordinate / 3) +
                             " moves; take another state or a smaller step");
}

/// The largest entry of |a - b| over that of |b|, or over `least` if that is larger; |a - b| itself where
/// both are zero. +∞ at an entry of a that is not finite, which no comparison would find.
DerivativeError largest_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double least) {
  Eigen::Index row = 0, column = 0;
  if (!a.allFinite()) {
    a.unaryExpr([](double entry) { return std::isfinite(entry) ? 0.0 : 1.0; }).maxCoeff(&row, &column);
    return {std::numeric_limits<double>::infinity(), static_cast<int>(row), static_cast<int>(column)};
  }
  const double error = (a - b).cwiseAbs().maxCoeff(&row, &column),
               scale = std::max(b.cwiseAbs().maxCoeff(), least);
  return {scale > 0 ? error / scale : error, static_cast<int>(row), static_cast<int>(column)};
}

/// Differences of derivatives do not show what add_gradient does to what is there already, nor what it
/// returns.
void require_contract(const BoundEnergy& energy, const Positions& x, const Positions& g, double returned,
                      double value, double h) {
  const double largest = g.cwiseAbs().maxCoeff(), other = largest > 0 ? largest : 1;
  Positions twice = Positions::Constant(x.rows(), 3, other);
  energy.add_gradient(x, twice);
  if (!((twice.array() - other - g.array()).abs().maxCoeff() <= 1e-9 * other))
    throw std::runtime_error("add_gradient does not add to the numbers in g, but overwrites some");
  if (!(std::abs(returned - value) <= 1e-8 * (std::max(std::abs(returned), std::abs(value)) + largest * h)))
    throw std::runtime_error("add_gradient returns " + general_text(returned, 9) + ", but value " +
                             general_text(value, 9) + "; both are the energy");
}

std::string place_of(int coordinate) { return std::to_string(coordinate / 3) + ", " + "xyz"[coordinate % 3]; }

std::string text_of(double error) {
  return std::isfinite(error) ? "largest error " + scientific_text(error, 2) + ","
                              : std::string("NOT FINITE");
}

}  // namespace

std::string DerivativeCheck::text() const {
  const std::string of_gradient =
      "gradient: " + text_of(gradient.error) + " at vertex " + place_of(gradient.row) + "\nhessian: ";
  if (!std::isfinite(gradient.error)) return of_gradient + "not checked, since it takes finite gradients\n";
  return of_gradient + text_of(hessian.error) + " at vertices " + place_of(hessian.row) + " and " +
         place_of(hessian.column) +
         (std::isfinite(hessian.error) ? "; asymmetry " + scientific_text(asymmetry, 2) : std::string()) +
         "\n";
}

Level checked_level() { return Level::of(0, grid({0.02, 0.02}, 3, 3, Diagonals::one_way)); }

Positions checked_state(const Level& level) {
  const double edge = std::sqrt(2 * level.vertex_area.sum() / level.triangle_count());
  Eigen::Matrix3d f;
  f << 1.05, 0.03, 0, 0.01, 0.97, 0, 0.1, 0.2, 1;
  Positions x = level.rest.vertices * f.transpose();
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (int c = 0; c < 3; ++c) x(i, c) += 0.02 * edge * std::sin(static_cast<double>(7 * i + 3 * c + 1));
  return x;
}

DerivativeCheck check_derivatives(const BoundEnergy& energy, const Positions& x, double h) {
  if (x.size() == 0 || !(h > 0)) throw std::runtime_error("a check needs vertices and a step above 0");
  DerivativeCheck check;
  Positions g = Positions::Zero(x.rows(), 3);
  const double returned = add_gradient_of(energy, "that is checked", x, g), value = energy.value(x);
  if (!std::isfinite(value) || !std::isfinite(returned))
    throw std::runtime_error("the energy is not finite at this state: value is " + general_text(value, 9) +
                             ", add_gradient returns " + general_text(returned, 9) + "; take another state");
  const Eigen::Map<const Eigen::VectorXd> gradient(g.data(), g.size());
  if (!g.allFinite()) {
    check.gradient = largest_error(gradient, gradient, 0);
    return check;
  }
  require_contract(energy, x, g, returned, value, h);
  const Eigen::MatrixXd hessian = dense(hessian_of(energy, x, Projection::none));
  Eigen::VectorXd by_value = Eigen::VectorXd::Zero(x.size());
  Eigen::MatrixXd by_gradient = Eigen::MatrixXd::Zero(x.size(), x.size());
  Positions y = x, moved(x.rows(), 3);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      y.data()[i] = x.data()[i] + offsets[k] * h;
      moved.setZero();
      energy.add_gradient(y, moved);
      const double at_y = energy.value(y);
      require_finite(std::isfinite(at_y), "the energy is", i);
      require_finite(moved.allFinite(), "the gradient is", i);
      by_value[i] += weights[k] * at_y / (12 * h);
      by_gradient.col(i) +=
          weights[k] / (12 * h) * Eigen::Map<const Eigen::VectorXd>(moved.data(), moved.size());
    }
    y.data()[i] = x.data()[i];
  }
  // Where the energy or the forces are constant, their differences are round-off.
  const double round_off = 1e-8 / h;
  check.gradient = largest_error(gradient, by_value, round_off * std::abs(value));
  check.hessian = largest_error(hessian, by_gradient, round_off * g.cwiseAbs().maxCoeff());
  const double scale = hessian.cwiseAbs().maxCoeff();
  if (std::isfinite(check.hessian.error) && scale > 0)
    check.asymmetry = (hessian - hessian.transpose()).cwiseAbs().maxCoeff() / scale;
  return check;
}

DerivativeCheck check_derivatives(const Energy& energy, const Material& material) {
  const Level level = checked_level();
  const Positions x = checked_state(level);
  const auto bound = bound_energy(energy, level, material);
  if (!std::isfinite(bound->value(x)))
    throw std::runtime_error(
        "the energy is not finite at strains of 0.05, where derivatives are checked; check it with other "
        "parameters");
  constexpr double step = 1e-5;  // [m]
  DerivativeCheck best = check_derivatives(*bound, x, step);
  for (const double h : {step / 10, step / 100}) {
    if (best.agrees()) break;
    const DerivativeCheck check = check_derivatives(*bound, x, h);
    if (check.worst() < best.worst()) best = check;
  }
  return best;
}

double relative_force_at_rest(const Energy& energy, const Material& material) {
  const Level level = checked_level();
  const auto bound = bound_energy(energy, level, material);
  const auto largest_force = [&](const Positions& x) {
    Positions g = Positions::Zero(x.rows(), 3);
    add_gradient_of(*bound, "that is checked", x, g);
    return g.cwiseAbs().maxCoeff();
  };
  const double strained = largest_force(checked_state(level));
  return strained > 0 ? largest_force(level.rest.vertices) / strained : 0;
}

}  // namespace drape
