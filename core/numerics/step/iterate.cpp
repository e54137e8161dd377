#include "core/numerics/step/iterate.h"

#include <algorithm>
#include <cmath>

namespace drape {

namespace {

/// Relative differences of energies below this are round-off.
constexpr double relative_noise = 1e-12;

}  // namespace

Iterate::Iterate(Objective& objective, LevelResult& result)
    : f_(objective),
      result_(result),
      rest_diagonal_(bounding_box_diagonal(objective.model().level().rest.vertices)) {}

Eigen::RowVector3d Iterate::free_centroid() const {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (Eigen::Index i = 0; i < result_.x.rows(); ++i)
    if (!fixed_[i]) sum += result_.x.row(i);
  return sum / std::max(free_count_, 1.0);
}

void Iterate::set_constraints(const std::vector<char>& fixed, const BoundEnergy* penalty) {
  fixed_ = fixed;
  free_count_ = static_cast<double>(std::count(fixed_.begin(), fixed_.end(), 0));
  f_.set_penalty(penalty);
  if (gradient_.rows() == 0) return;
  evaluate();
  update_residual();
}

void Iterate::evaluate() {
  PhaseTimer t(result_.seconds_by_phase, "gradient");
  energy_ = f_.gradient(result_.x, gradient_);
}

void Iterate::update_residual() {
  s_.residual_scale = f_.residual_scale(result_.x, gradient_);
  result_.force_residual = free_norm(gradient_, fixed_) / s_.residual_scale;
}

void Iterate::update_friction() {
  if (!f_.contacts().any()) return;
  const bool had_friction = f_.contacts().has_friction();
  f_.contacts().update_lagging(result_.x);  // may find the first contacts
  if (!had_friction && !f_.contacts().has_friction()) return;
  evaluate();
  update_residual();
}

void Iterate::swap(Positions& x, Positions& gradient, double energy) {
  result_.x.swap(x);
  gradient_.swap(gradient);
  energy_ = energy;
}

void Iterate::set_model(std::shared_ptr<const LevelModel> model, const Positions& from) {
  PhaseTimer t(result_.seconds_by_phase, "gradient");  // builds collisions
  f_.set_model(std::move(model), from, result_.x);
}

const BlockMatrix& Iterate::hessian(Projection projection) const {
  PhaseTimer t(result_.seconds_by_phase, "hessian");
  return f_.matrix(result_.x, projection);
}

bool Iterate::has_gap_below(double fraction) const {
  ActiveContacts& contacts = f_.contacts();
  contacts.barrier(x());  // evaluates the contacts for smallest_gap()
  return contacts.any() && contacts.smallest_gap() < fraction * rest_diagonal_;
}

StepLimit Iterate::max_step(const Positions& x1) const {
  PhaseTimer t(result_.seconds_by_phase, "step filter");
  return f_.max_step(result_.x, x1);
}

double Iterate::energy_noise(double inertia) const {
  const double work = s_.residual_scale * std::sqrt(free_count_) * rest_diagonal_;
  return relative_noise * (std::abs(energy_ + inertia) + work);
}

}  // namespace drape
