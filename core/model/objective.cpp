#include "core/model/objective.h"

#include <cmath>

namespace drape {

double Objective::kept_smooth_gradient(const Positions& x, Positions& g) {
  if (evaluated_at_.rows() != x.rows() || evaluated_at_ != x) {
    smooth_energy_ = smooth_gradient(x, smooth_gradient_);
    evaluated_at_ = x;
  }
  g = smooth_gradient_;
  return smooth_energy_;
}

double Objective::gradient(const Positions& x, Positions& g) {
  double sum = kept_smooth_gradient(x, g);
  for (std::size_t k = 0; k < limits_.size() && std::isfinite(sum); ++k)
    sum += limits_[k]->add_gradient(x, g);
  if (penalty_) sum += penalty_->add_gradient(x, g);
  return std::isfinite(sum) ? sum + contacts_.add_gradient(x, g) : sum;
}

double Objective::plain_energy(const Positions& x) {
  double sum = model_.value(x) + contacts_.barrier(x);
  for (const BoundEnergy* limit : limits_) sum += limit->value(x);
  return sum;
}

const BlockMatrix& Objective::matrix(const Positions& x, Projection projection) {
  BlockMatrix& smooth = smooth_matrix(x, projection);
  std::vector<const BoundEnergy*> local = contacts_.energies(x);
  smooth_alone_ = local.empty() && limits_.empty() && !penalty_;
  gone_ = false;
  if (smooth_alone_) return smooth;
  std::vector<const BoundEnergy*> lasting = limits_;
  if (penalty_) lasting.push_back(penalty_);
  return sum_.add(smooth, lasting, local, x, projection);
}

void Objective::forget_room() {
  gone_ = gone_ || !(smooth_alone_ || sum_.room().blocks.empty());
  sum_ = SumMatrix();
}

void Objective::smooth_pattern_changed() {
  gone_ = true;
  sum_ = SumMatrix();
}

void Objective::model_changed(const BoundContacts& before, const Positions& from, const Positions& x) {
  smooth_changed();
  set_limits(model_.limits());
  contacts_.update_obstacles(before, from, x);
}

std::shared_ptr<const BlockPattern> Objective::restore(PatternMemory memory, const Positions& x) {
  const std::shared_ptr<const BlockPattern> smooth = smooth_matrix(x, Projection::none).pattern;
  const std::shared_ptr<const BlockPattern>& whole = sum_.restore(smooth, std::move(memory.room));
  smooth_alone_ = memory.smooth_alone;
  gone_ = memory.gone;
  return gone_ ? nullptr : smooth_alone_ ? smooth : whole;
}

StepLimit Objective::max_step(const Positions& x0, const Positions& x1) {
  StepLimit limit;
  for (const BoundEnergy* energy : limits_)
    if (const auto* filter = dynamic_cast<const StepFilter*>(energy)) {
      StepLimit own = filter->max_step(x0, x1);
      if (own.fraction < limit.fraction) limit = std::move(own);
    }
  if (!contacts_.any()) return limit;
  const StepLimit apart = contacts_.max_step(x0, x0 + limit.fraction * (x1 - x0));
  if (apart.fraction < 1) limit = {limit.fraction * apart.fraction, apart.by};
  return limit;
}

}  // namespace drape
