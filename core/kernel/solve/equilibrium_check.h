#pragma once

#include <array>

#include "core/kernel/solve/iterate.h"
#include "core/kernel/solve/newton_parameters.h"
#include "core/kernel/solve/rounding_floor.h"

namespace drape {

/// Decides whether the iterate is at equilibrium, within the tolerances or as near as round-off allows, and
/// measures how far the cloth has drifted.
class EquilibriumCheck {
 public:
  struct State {
    std::array<double, 3> decrements{};        ///< of the last iterations [m/s]
    std::array<double, 3> initial_centroid{};  ///< of the free vertices where the drift begins [m]
    IdleSteps::State idle;
  };
  State state() const;
  void restore(const State& state);

  /// Refers to both arguments.
  EquilibriumCheck(Iterate& iterate, const NewtonParameters& parameters)
      : iterate_(iterate), p_(parameters) {}

  /// Whether the tolerances are met, with friction lagged at the iterate.
  bool in_tolerance();
  /// Whether progress has stopped: many idle steps.
  bool is_idle() const { return idle_.many(); }
  /// Whether all forces are within their round-off bounds, with friction lagged at the iterate. Counts idle
  /// steps anew. Assembles the Hessian over the objective's last, so it is called only once progress has
  /// stopped.
  bool is_at_rounding_floor();
  /// Bound on the force residual by round-off at the last such check [1].
  double rounding_residual() const { return rounding_residual_; }
  /// Distance of the free vertices' centroid from where the drift begins, in diagonals of the rest shape.
  double drift() const;

  /// Notes the decrement of an iteration, before the iteration is counted.
  void note_decrement(double decrement) { decrements_[iterate_.result().iterations % 3] = decrement; }
  /// Notes the end of a step with this `inertia` [J].
  void note_step(double inertia);
  /// Counts idle steps anew, for another objective.
  void restart_idle_steps() { idle_.restart(); }
  /// Lets the drift begin here.
  void restart_drift() { initial_centroid_ = iterate_.free_centroid(); }

 private:
  Iterate& iterate_;
  const NewtonParameters& p_;
  std::array<double, 3> decrements_{};
  Eigen::RowVector3d initial_centroid_ = Eigen::RowVector3d::Zero();
  IdleSteps idle_;
  double rounding_residual_ = 0;
};

}  // namespace drape
