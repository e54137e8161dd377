#pragma once

#include <array>
#include <limits>

#include "core/numerics/step/cycle_detector.h"
#include "core/numerics/step/factor_cache.h"
#include "core/numerics/step/iterate.h"
#include "core/numerics/step/newton_parameters.h"
#include "core/numerics/step/rounding_floor.h"

namespace drape {

/// Decides whether the iterate is at equilibrium, within the tolerances or as near as round-off allows, and
/// measures how far the cloth has drifted.
class EquilibriumCheck {
 public:
  struct State {
    static constexpr double unknown = std::numeric_limits<double>::infinity();
    /// Decrements of the last three iterations; iteration k is at k mod 3 [m/s].
    std::array<double, 3> decrements = {unknown, unknown, unknown};
    /// The centroid of the free vertices where the drift begins [m].
    Eigen::RowVector3d initial_centroid = Eigen::RowVector3d::Zero();
    IdleSteps idle = {};
    CycleDetector cycle = {};
    double lowest_residual = unknown;  ///< the lowest force residual at the end of a step [1]
    int steps_since_lowest = 0;        ///< how many steps ago that was
    double strictness = 1;             ///< the force tolerance is divided by it
    double slack = 1;                  ///< the force tolerance is multiplied by it
  };
  const State& state() const { return s_; }
  void restore(const State& state) { s_ = state; }

  /// Refers to both arguments.
  EquilibriumCheck(Iterate& iterate, const NewtonParameters& parameters)
      : iterate_(iterate), p_(parameters) {}

  /// Whether the force residual is at most this many times its tolerance, and the decrement within its own.
  bool is_within(double times) const;
  /// Whether the tolerances are met. If they seem to be, lags friction at the iterate and checks them again.
  bool in_tolerance();
  /// Whether progress has stopped: many idle steps.
  bool is_idle() const { return s_.idle.many(); }
  /// Whether steps lead round and round.
  bool is_cycling() const { return s_.cycle.cycling(); }
  /// Looks for a new cycle, after the solver has done something about the last one.
  void restart_cycle() { s_.cycle = {}; }
  /// Whether all forces are within their round-off bounds. Lags friction at the iterate first, and restarts
  /// the count of idle steps. Call it only once progress has stopped: it assembles the Hessian.
  bool is_at_rounding_floor(FactorCache& factor);
  /// Bound on the force residual by round-off at the last such check [1].
  double rounding_residual() const { return rounding_residual_; }
  /// Distance of the free vertices' centroid from where the drift begins, in diagonals of the rest shape.
  double drift() const {
    return (iterate_.free_centroid() - s_.initial_centroid).norm() / iterate_.rest_diagonal();
  }

  /// The force tolerance [1].
  double force_tolerance() const { return p_.force_tolerance * s_.slack / s_.strictness; }
  /// Divides the force tolerance by this; 1 ends it.
  void tighten(double strictness) { s_.strictness = strictness; }
  /// Multiplies the force tolerance by `slack`, until the next call.
  void set_slack(double slack) { s_.slack = slack; }

  /// Notes the decrement of an iteration, before the iteration is counted.
  void note_decrement(double decrement) { s_.decrements[iterate_.result().iterations % 3] = decrement; }
  /// Notes the end of a step with this `inertia` [J].
  void note_step(double inertia);
  /// For another objective: restarts the count of idle steps, and forgets cycles, residuals and decrements.
  void restart() {
    s_ = {.initial_centroid = s_.initial_centroid, .strictness = s_.strictness, .slack = s_.slack};
  }
  /// Measures the drift from here on.
  void restart_drift() { s_.initial_centroid = iterate_.free_centroid(); }

 private:
  Iterate& iterate_;
  const NewtonParameters& p_;
  State s_;
  double rounding_residual_ = 0;
};

}  // namespace drape
