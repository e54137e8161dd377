#include "core/numerics/step/implicit_step.h"

#include <cmath>

namespace drape {

void ImplicitStep::evaluate(const Iterate& iterate, double inverse_h2) {
  const Eigen::VectorXd& masses = iterate.model().masses();
  const std::vector<char>& fixed = iterate.fixed();
  const Positions& x = iterate.x();
  gradient_ = iterate.gradient();
  inertia_ = 0;
  inverse_h2_ = inverse_h2;
  for (Eigen::Index i = 0; i < gradient_.rows(); ++i) {
    if (fixed[i]) {
      gradient_.row(i).setZero();
      continue;
    }
    const double m = inverse_h2 * masses[i];
    const Eigen::RowVector3d moved = x.row(i) - origin_.row(i);
    gradient_.row(i) += m * moved;
    inertia_ += 0.5 * m * moved.squaredNorm();
  }
}

double ImplicitStep::inertia_at(const Positions& x, const Eigen::VectorXd& masses) const {
  double sum = 0;
  if (inverse_h2_ > 0)
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      sum += 0.5 * inverse_h2_ * masses[i] * (x.row(i) - origin_.row(i)).squaredNorm();
  return sum;
}

double ImplicitStep::gradient_norm_at(const Positions& x, const Positions& gradient,
                                      const Iterate& iterate) const {
  const Eigen::VectorXd& masses = iterate.model().masses();
  const std::vector<char>& fixed = iterate.fixed();
  double sum = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (!fixed[i])
      sum += (gradient.row(i) + inverse_h2_ * masses[i] * (x.row(i) - origin_.row(i))).squaredNorm();
  return std::sqrt(sum);
}

}  // namespace drape
