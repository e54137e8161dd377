#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "core/numerics/solve/dirichlet_enforcer.h"
#include "core/numerics/step/iterate.h"

namespace drape {

/// Thrown by LoadStepping::advance where no load may follow, with the reason: the level is infeasible.
struct LoadRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// When the current increment began.
struct IncrementStart {
  int steps = 0, iterations = 0;  ///< of the level
};

/// Motion of the cloth in answer to a partly applied increment; the predictor extrapolates it.
struct IncrementResponse {
  Positions from;       ///< the equilibrium before (n×3) [m]
  Positions predicted;  ///< where the predictor moved it (n×3) [m]
  double fraction = 0;  ///< applied of what remained of the increment; 0 without a response
};

/// Applies the increments of load stepping to a level that is being solved. An increment that the cloth does
/// not allow at once is applied in parts, with the cloth's response extrapolated (docs/guide/schedules.md).
class LoadStepper {
 public:
  struct State {
    IncrementStart start;  ///< of the current increment
    IncrementResponse response;
    /// Consecutive attempts at the current increment that applied almost nothing.
    int blocked_increments = 0;
  };
  State state() const { return s_; }
  void restore(const State& state) { s_ = state; }

  /// Refers to all arguments; without load stepping (null) there are no increments.
  LoadStepper(LoadStepping* load_stepping, Iterate& iterate, const DirichletEnforcer& dirichlet,
              Observer& observer);

  /// Whether increments remain.
  bool loading() const { return load_stepping_ && !load_stepping_->finished(); }
  /// Whether the next increment begins without equilibrium, after a step of that length. The remainder of an
  /// increment waits for equilibrium: each partial increment shrinks gaps tenfold, and a step widens them
  /// only twofold. Where increments make room, the next waits for steps that contact does not shorten, but
  /// not long.
  bool advances_at_once(double step_length) const {
    const bool follows = step_length == 1 || steps() % max_steps_between_advances == 0;
    return loading() && !load_stepping_->equilibrates() && load_stepping_->complete() &&
           (follows || !makes_room());
  }
  /// Whether an equilibrium is that of a whole increment, which is to be solved to equilibrium.
  bool ends_increment() const {
    return load_stepping_ && load_stepping_->equilibrates() && load_stepping_->complete();
  }
  /// Steps of the current increment so far.
  int steps() const { return iterate_.result().steps - s_.start.steps; }
  /// Pseudo-time of the current increment; none without a schedule.
  std::optional<double> time() const {
    return load_stepping_ ? std::optional(load_stepping_->time()) : std::nullopt;
  }
  /// How many times the force tolerance is enough for an equilibrium of the current increment [1].
  double slack() const { return load_stepping_ ? load_stepping_->slack() : 1; }
  /// Whether the current increment only makes room for the next, which is then not solved to equilibrium.
  bool makes_room() const { return slack() > 1; }
  /// Stores how far load stepping has come.
  void store_progress(LevelResult& result) const;

  /// Begins the next increment or continues the current one, as far as limits and contact allow. Does not
  /// evaluate the iterate.
  void advance(bool at_equilibrium);
  /// Whether the current increment cannot be completed, or the next not begin.
  bool blocked() const;
  /// Why.
  const std::string& blocked_text() const { return blocked_text_; }
  /// Reports the current increment to the observer; does nothing without a schedule.
  void report_increment();

 private:
  static constexpr int max_steps_between_advances = 5;

  double trust_factor() const;
  double extrapolate();
  bool step_back();
  StepLimit advance_alone();
  bool advance_with(const Positions& trial, double fraction);
  bool is_finite_at(const Positions& x);
  void update_model(const Positions& from);

  LoadStepping* load_stepping_;
  Iterate& iterate_;
  const DirichletEnforcer& dirichlet_;
  Observer& observer_;
  State s_;
  std::string limit_text_;  // what limited the last advance, as Iterate::limit_text()
  std::string blocked_text_;
};

}  // namespace drape
