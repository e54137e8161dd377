#include "core/numerics/step/rounding_floor.h"

#include <cmath>

namespace drape {

namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

}  // namespace

Eigen::VectorXd rounding_bounds(const BlockMatrix& hessian, const Positions& x) {
  Eigen::VectorXd bounds = Eigen::VectorXd::Zero(x.rows());
  hessian.pattern->for_each_block([&](int i, int j, int b) {
    const double norm = unit_roundoff * Eigen::Map<const Eigen::Matrix3d>(hessian.block(b)).norm();
    bounds[i] += norm * x.row(j).norm();
    if (j != i) bounds[j] += norm * x.row(i).norm();
  });
  return bounds;
}

RoundingFloor rounding_floor(const BlockMatrix& hessian, const Positions& x, const Positions& gradient,
                             const std::vector<char>& fixed) {
  const Eigen::VectorXd bounds = rounding_bounds(hessian, x);
  RoundingFloor floor{0, true};
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (fixed[i]) continue;
    floor.norm = std::hypot(floor.norm, bounds[i]);
    floor.reached = floor.reached && gradient.row(i).norm() <= bounds[i];
  }
  return floor;
}

void IdleSteps::note(double new_energy, double new_residual, double noise) {
  if (std::abs(new_energy - energy) <= noise && new_residual > 0.5 * residual)
    ++steps;
  else
    *this = {0, new_energy, new_residual};
}

}  // namespace drape
