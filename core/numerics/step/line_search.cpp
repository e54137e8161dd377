#include "core/numerics/step/line_search.h"

#include <cmath>

namespace drape {

namespace {

/// Armijo's constant.
constexpr double sufficient_decrease = 1e-4;

}  // namespace

bool LineSearch::search(Iterate& iterate, const ImplicitStep& step, const Positions& direction) {
  slope_ = step.gradient().cwiseProduct(direction).sum();
  iterate.set_limited_by("");  // that was another direction's
  if (!(slope_ < 0)) return false;
  trial_ = iterate.x() + direction;
  const StepLimit limit = iterate.max_step(trial_);
  iterate.set_limited_by(limit.by);

  PhaseTimer t(iterate.result().seconds_by_phase, "gradient");
  const Eigen::VectorXd& masses = iterate.model().masses();
  const double norm_before = free_norm(step.gradient(), iterate.fixed());
  double& alpha = step_length_;
  for (alpha = limit.fraction; alpha >= min_step_length; alpha *= 0.5) {
    trial_ = iterate.x() + alpha * direction;
    const double energy = iterate.objective().gradient(trial_, trial_gradient_);
    if (!std::isfinite(energy)) continue;
    const double change = energy - iterate.energy() + step.inertia_at(trial_, masses) - step.inertia();
    bool accept = change <= sufficient_decrease * alpha * slope_;
    if (!accept && std::abs(change) <= iterate.energy_noise(step.inertia()))
      accept = step.gradient_norm_at(trial_, trial_gradient_, iterate) < norm_before;
    if (!accept) continue;
    iterate.swap(trial_, trial_gradient_, energy);
    return true;
  }
  return false;
}

}  // namespace drape
