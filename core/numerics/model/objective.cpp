#include "core/numerics/model/objective.h"

#include <cmath>

#include "core/numerics/model/required.h"

namespace drape {

double Objective::gradient(const Positions& x, Positions& g) {
  if (evaluated_at_.rows() != x.rows() || evaluated_at_ != x) {
    smooth_energy_ = smooth_gradient(x, smooth_gradient_);
    evaluated_at_ = x;
  }
  g = smooth_gradient_;
  double sum = smooth_energy_;
  for (std::size_t k = 0; k < limits_.size() && std::isfinite(sum); ++k)
    sum += add_gradient_of(*limits_[k], "of role limit", x, g);
  if (penalty_) sum += penalty_->add_gradient(x, g);
  return std::isfinite(sum) ? sum + contacts_.add_gradient(x, g) : sum;
}

const BlockMatrix& Objective::matrix(const Positions& x, Projection projection) {
  BlockMatrix& smooth = smooth_matrix(x, projection);
  std::vector<const BoundEnergy*> transient = contacts_.energies(x);
  smooth_only_ = transient.empty() && limits_.empty() && !penalty_;
  invalidated_ = false;
  if (smooth_only_) return smooth;
  std::vector<const BoundEnergy*> persistent = limits_;
  if (penalty_) persistent.push_back(penalty_);
  return assembler_.add(smooth, persistent, transient, x, projection);
}

void Objective::invalidate_pattern() {
  invalidated_ = invalidated_ || !(smooth_only_ || assembler_.extra().blocks.empty());
  assembler_ = HessianAssembler();
}

void Objective::smooth_pattern_changed() {
  invalidated_ = true;
  assembler_ = HessianAssembler();
}

void Objective::set_model(std::shared_ptr<const LevelModel> model, const Positions& from,
                          const Positions& x) {
  model_ = std::move(model);
  model_changed();
  smooth_changed();
  set_limits(model_->limits());
  contacts_.update_obstacles(model_->contacts(), from, x);
}

std::shared_ptr<const BlockPattern> Objective::restore(PatternState state, const Positions& x) {
  const std::shared_ptr<const BlockPattern> smooth = smooth_matrix(x, Projection::none).pattern;
  const std::shared_ptr<const BlockPattern>& whole = assembler_.restore(smooth, std::move(state.extra));
  smooth_only_ = state.smooth_only;
  invalidated_ = state.invalidated;
  return invalidated_ ? nullptr : smooth_only_ ? smooth : whole;
}

StepLimit Objective::max_step(const Positions& x0, const Positions& x1) {
  StepLimit limit;
  for (const BoundEnergy* energy : limits_) {
    StepLimit own = energy->max_step(x0, x1);
    if (own.fraction < limit.fraction) limit = std::move(own);
  }
  if (!contacts_.any()) return limit;
  const StepLimit contact = contacts_.max_step(x0, x0 + limit.fraction * (x1 - x0));
  if (contact.fraction < 1) limit = {limit.fraction * contact.fraction, contact.by};
  return limit;
}

}  // namespace drape
