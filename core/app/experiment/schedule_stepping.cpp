#include "core/app/experiment/schedule_stepping.h"

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

ScheduleStepping::ScheduleStepping(LoadSchedule schedule, const Scene& scene)
    : schedule_(std::move(schedule)), load_(schedule_.first()) {
  for (const auto& model : scene.models) levels_.push_back({load_, load_, model});
}

std::shared_ptr<const LevelModel> ScheduleStepping::model(int level) {
  LoadedLevel& l = levels_[level];
  if (l.made_of != l.load) {
    l.model = schedule_.model(*l.load, level, *l.model);
    l.made_of = l.load;
  }
  return l.model;
}

std::shared_ptr<const LoadState> ScheduleStepping::load_at(std::vector<double> values) const {
  try {
    return schedule_.at(std::move(values), *load_);
  } catch (const std::exception& error) {
    throw std::runtime_error("the schedule at pseudo-time " + std::to_string(time()) + ": " + error.what());
  }
}

void ScheduleStepping::set_load(int level, std::shared_ptr<const LoadState> load) {
  load_ = std::move(load);
  for (std::size_t l = level; l < levels_.size(); ++l) levels_[l].load = load_;
}

void ScheduleStepping::begin(int level, bool from_start) {
  if (from_start)
    restore(level, {0, schedule_.values(0)});
  else
    set_load(level, load_);
}

void ScheduleStepping::restore(int level, const LoadSteppingState& state) {
  increment_ = state.increment;
  set_load(level, load_at(state.values));
}

StepLimit ScheduleStepping::advance(int level, const Positions& x) {
  if (complete()) ++increment_;
  StepLimit limit;
  double part = 1;
  for (int tries = 0; tries < max_tries && part >= min_fraction; ++tries) {
    StepLimit allowed = try_fraction(part, level, x);
    if (allowed.fraction == 1) {
      limit.fraction = part;
      return limit;
    }
    if (!allowed.by.empty()) limit.by = std::move(allowed.by);
    part *= allowed.fraction;
  }
  limit.fraction = 0;
  return limit;
}

bool ScheduleStepping::advance_by(double fraction, int level, const Positions& x) {
  return try_fraction(fraction, level, x).fraction == 1;
}

StepLimit ScheduleStepping::try_fraction(double fraction, int level, const Positions& x) {
  std::vector<double> values = schedule_.values(increment_);
  if (fraction < 1)
    for (std::size_t c = 0; c < values.size(); ++c)
      values[c] = load_->values[c] + fraction * (values[c] - load_->values[c]);
  if (fraction < 1 && values == load_->values) return {0, {}};  // less than the numbers can express
  const std::shared_ptr<const LoadState> next = load_at(std::move(values));
  const std::shared_ptr<const LevelModel> now = model(level);
  std::shared_ptr<const LevelModel> then = schedule_.model(*next, level, *now);
  if (std::string refused = strain_limit_violations(then->limits(), x, 1); !refused.empty())
    return {0.5, std::move(refused)};  // a limit gives no fraction: try half
  if (StepLimit limit = obstacle_step_limit(*now, *then, x); limit.fraction < 1) return limit;
  set_load(level, next);
  levels_[level] = {next, next, std::move(then)};
  return {};
}

}  // namespace drape
