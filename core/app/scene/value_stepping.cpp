#include "core/app/scene/value_stepping.h"

#include <stdexcept>

#include "core/numerics/model/stretch_limit.h"

namespace drape {

namespace {

/// An increment is tried at most this often, in ever smaller fractions, before it waits for equilibrium.
constexpr int max_tries = 30;
constexpr double min_fraction = 1e-6;  // of what remains of the increment

/// Largest feasible motion of the obstacles from one model to the other with the cloth at x.
StepLimit obstacle_step_limit(const LevelModel& from, const LevelModel& to, const Positions& x) {
  StepLimit limit;
  for (std::size_t k = 0; k < to.contacts().size(); ++k) {
    if (to.contacts()[k] == from.contacts()[k]) continue;
    StepLimit own = to.contacts()[k]->max_step(*from.contacts()[k], x);
    if (own.fraction < limit.fraction) limit = std::move(own);
  }
  return limit;
}

}  // namespace

ValueStepping::ValueStepping(const Scene& scene, std::shared_ptr<const LoadState> first)
    : scene_(scene), load_(std::move(first)) {
  for (const auto& model : scene.models) levels_.push_back({load_, load_, model});
}

void ValueStepping::begin(int level, bool from_start) {
  if (from_start)
    restore(level, {0, values(0)});
  else
    set(level, increment_, load_);
}

void ValueStepping::restore(int level, const LoadSteppingState& state) {
  increment_ = state.increment;
  set(level, increment_, next_load(state.values));
}

std::shared_ptr<const LevelModel> ValueStepping::model(int level) {
  LoadedLevel& l = levels_[level];
  if (l.made_of != l.load) {
    l.model = model_under(*l.load, scene_, level, *l.model);
    l.made_of = l.load;
  }
  return l.model;
}

StepLimit ValueStepping::advance(int level, const Positions& x) {
  if (complete()) ++increment_;
  StepLimit limit{0, {}};
  double part = 1;
  for (int tries = 0; tries < max_tries && part >= min_fraction; ++tries) {
    StepLimit allowed = try_fraction(part, level, x);
    if (allowed.fraction == 1) return {part, std::move(limit.by)};
    if (!allowed.by.empty()) limit.by = std::move(allowed.by);
    part *= allowed.fraction;
  }
  return limit;
}

void ValueStepping::set(int level, int increment, std::shared_ptr<const LoadState> load) {
  increment_ = increment;
  load_ = std::move(load);
  for (std::size_t l = level; l < levels_.size(); ++l) levels_[l].load = load_;
}

/// The load with these values, made from the current one. Throws std::runtime_error naming the pseudo-time
/// and the fault.
std::shared_ptr<const LoadState> ValueStepping::next_load(std::vector<double> values) const {
  try {
    return load_at(std::move(values), *load_);
  } catch (const std::exception& error) {
    throw std::runtime_error("the schedule at pseudo-time " + std::to_string(time()) + ": " + error.what());
  }
}

/// Applies a fraction of the remaining increment if a cloth at x allows it. Returns 1 if so, else an
/// estimate of the feasible part of that fraction.
StepLimit ValueStepping::try_fraction(double fraction, int level, const Positions& x) {
  std::vector<double> own = values(increment_);
  if (fraction < 1)
    for (std::size_t c = 0; c < own.size(); ++c)
      own[c] = load_->values[c] + fraction * (own[c] - load_->values[c]);
  if (fraction < 1 && own == load_->values) return {0, {}};  // less than the numbers can express
  std::shared_ptr<const LoadState> next = begun_at(next_load(std::move(own)), level, x);
  const std::shared_ptr<const LevelModel> now = model(level);
  std::shared_ptr<const LevelModel> then = model_under(*next, scene_, level, *now);
  if (std::string refused = strain_limit_violations(then->limits(), x, 1); !refused.empty())
    return {0.5, std::move(refused)};  // a limit gives no fraction: try half
  if (StepLimit limit = obstacle_step_limit(*now, *then, x); limit.fraction < 1) return limit;
  set(level, increment_, next);
  levels_[level] = {next, next, std::move(then)};
  return {};
}

}  // namespace drape
