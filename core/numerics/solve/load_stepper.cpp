#include "core/numerics/solve/load_stepper.h"

#include <algorithm>
#include <cmath>

#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// At equilibrium, an increment that advances by less than this fraction of its remainder is blocked. An
/// obstacle advances by about its gap at a time, so a very long motion counts as blocked too.
constexpr double blocked_increment = 1e-3;
/// Blocked attempts in a row after which a load is infeasible.
constexpr int max_blocked_increments = 20;
/// A blocked attempt below this gap, as a fraction of the bounding box diagonal, makes the load infeasible at
/// once: cloth between two surfaces that close cannot widen its gaps.
constexpr double min_gap = 1e-7;
/// Extrapolate at most four times the last increment.
constexpr double max_trust = 4;
/// Trust the predictor so far that equilibrium corrects this fraction of its displacement.
constexpr double predictor_error = 0.1;
/// Smallest pass of the predictor, as a fraction of its whole reach.
constexpr double min_pass = 1e-3;
constexpr int max_passes = 100;
/// The predictor stops once it has reduced the smallest gap to this fraction.
constexpr double gap_reduction = 0.5;
/// Time of obstacles' motion and of models for new loads.
constexpr const char* load_phase = "load stepping";

}  // namespace

LoadStepper::LoadStepper(LoadStepping* load_stepping, Iterate& iterate, const DirichletEnforcer& dirichlet,
                         Observer& observer)
    : load_stepping_(load_stepping), iterate_(iterate), dirichlet_(dirichlet), observer_(observer) {}

void LoadStepper::store_progress(LevelResult& result) const {
  if (load_stepping_) result.load_stepping = load_stepping_->state();
}

bool LoadStepper::blocked() const { return !blocked_text_.empty(); }

void LoadStepper::advance(bool at_equilibrium) {
  const LevelResult& result = iterate_.result();
  const bool begins = load_stepping_->complete();
  if (begins && (at_equilibrium || load_stepping_->increment() > 0)) report_increment();
  if (begins) s_.start = {result.steps, result.iterations};
  if (begins && step_back()) return;
  const Positions from = iterate_.x();
  double applied = at_equilibrium && !begins ? extrapolate() : 0;
  Positions predicted = iterate_.x();
  // If the predictor gains no more than the last time, the obstacles advance without it.
  if ((begins || !load_stepping_->complete()) && applied < 1 &&
      applied * (1 - s_.response.fraction) <= s_.response.fraction) {
    StepLimit limit;
    try {
      limit = advance_alone();
    } catch (const LoadRefused& refused) {
      blocked_text_ = refused.what();
      return;
    }
    iterate_.set_limited_by(limit.by);
    limit_text_ = iterate_.limit_text();  // the pins' move that follows has a limit of its own
    applied += limit.fraction * (1 - applied);
    predicted = from;  // the cloth has not responded yet
    update_model(iterate_.x());
  }
  s_.response = at_equilibrium && !load_stepping_->complete()
                    ? IncrementResponse{from, std::move(predicted), applied}
                    : IncrementResponse();
  const bool closed = iterate_.has_gap_below(min_gap);
  s_.blocked_increments = at_equilibrium && applied < blocked_increment
                              ? (closed ? max_blocked_increments : s_.blocked_increments + 1)
                              : 0;
  if (s_.blocked_increments < max_blocked_increments) return;
  blocked_text_ = "the increment to pseudo-time " + three_digits(load_stepping_->time()) +
                  " cannot be completed" + limit_text_;
  if (closed)
    blocked_text_ += "; the gap is " + three_digits(iterate_.objective().contacts().smallest_gap()) +
                     " m: at its target the obstacle touches or crosses the cloth";
  else
    blocked_text_ +=
        "; if there is room up to the target, raise the schedule's \"steps\": a part below a thousandth of "
        "what remains of an increment counts as none";
}

/// Goes back to an earlier load, with the cloth as it was then, if load stepping asks for that.
bool LoadStepper::step_back() {
  const Positions* back = load_stepping_->step_back(iterate_.result().level, iterate_.x());
  if (!back) return false;
  iterate_.objective().contacts().reset();
  iterate_.move_to(*back);
  update_model(iterate_.x());
  s_.response = IncrementResponse();
  s_.blocked_increments = 0;
  return true;
}

/// Gives the iterate the model of the load that was reached. The cloth was at `from` when the load changed.
void LoadStepper::update_model(const Positions& from) {
  std::shared_ptr<const LevelModel> model;
  {
    PhaseTimer t(iterate_.result().seconds_by_phase, load_phase);
    model = load_stepping_->model(iterate_.result().level);
  }
  iterate_.set_model(std::move(model), from);
}

/// Largest extrapolation factor: smaller the more equilibrium has corrected the last prediction.
double LoadStepper::trust_factor() const {
  const double displacement = (s_.response.predicted - s_.response.from).norm();
  const double correction = (iterate_.x() - s_.response.predicted).norm();
  return correction * max_trust < predictor_error * displacement || displacement == 0
             ? max_trust
             : std::max(predictor_error * displacement / correction, 1 / max_trust);
}

/// Predictor for an increment that is applied in parts: extrapolates the cloth's response to the last part,
/// as far as the trust factor allows. In each pass first the cloth moves as far as contact and limits allow,
/// then the obstacles follow. Returns the fraction applied of the remaining increment; 0 without a response.
double LoadStepper::extrapolate() {
  const double last = s_.response.fraction;
  if (last == 0) return 0;
  ActiveContacts& contacts = iterate_.objective().contacts();
  const Positions from = iterate_.x(), direction = (from - s_.response.from) * ((1 - last) / last);
  const double reach = std::min(1.0, trust_factor() * last / (1 - last)), gap = contacts.smallest_gap();
  if (reach < blocked_increment) return 0;
  Positions trial;
  double applied = 0, pass = reach;
  for (int tries = 0; tries < max_passes && applied < reach && pass >= min_pass * reach; ++tries) {
    const Positions here = iterate_.x();
    pass = std::min(pass, reach - applied);
    trial = from + (applied + pass) * direction;
    if (const double allowed = iterate_.max_step(trial).fraction; allowed < 1) {
      pass *= 0.5 * allowed;  // leaves room for the obstacles to follow
      if (pass < min_pass * reach) break;
      trial = from + (applied + pass) * direction;
    }
    if (!is_finite_at(trial) || !advance_with(trial, pass / (1 - applied))) {
      pass *= 0.5;
      continue;
    }
    iterate_.move_to(trial);
    update_model(here);
    applied += pass;
    if (contacts.smallest_gap() < gap_reduction * gap) break;
    pass *= 2;
  }
  return applied;
}

/// Advances the load as far as the cloth at x allows.
StepLimit LoadStepper::advance_alone() {
  PhaseTimer t(iterate_.result().seconds_by_phase, load_phase);
  return load_stepping_->advance(iterate_.result().level, iterate_.x());
}

/// Advances the load by this fraction of the remaining increment if a cloth at `trial` allows it.
bool LoadStepper::advance_with(const Positions& trial, double fraction) {
  PhaseTimer t(iterate_.result().seconds_by_phase, load_phase);
  return load_stepping_->advance_by(fraction, iterate_.result().level, trial);
}

bool LoadStepper::is_finite_at(const Positions& x) {
  PhaseTimer t(iterate_.result().seconds_by_phase, "gradient");
  Positions gradient;
  return std::isfinite(iterate_.objective().gradient(x, gradient));
}

void LoadStepper::report_increment() {
  if (!load_stepping_) return;
  const LevelResult& result = iterate_.result();
  IncrementRow row;
  row.level = result.level;
  row.increment = load_stepping_->increment();
  row.time = load_stepping_->time();
  row.steps = result.steps - s_.start.steps;
  row.iterations = result.iterations - s_.start.iterations;
  row.energy = iterate_.energy_without_friction();
  row.force_residual = result.force_residual;
  row.max_constraint_violation = dirichlet_.max_violation();
  observer_.increment_finished(row, result.x);
}

}  // namespace drape
