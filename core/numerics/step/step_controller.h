#pragma once

#include <limits>

#include "core/numerics/step/newton_parameters.h"

namespace drape {

/// Controls the damping of implicit steps: the step size h, or in the static form, which has none, the mass
/// that is added to the matrix.
///
/// h grows after full steps and shrinks after short ones; without descent it is divided by four. Near a
/// strain limit full steps gain no margin, and forces stay a thousand times the load: h is then divided by
/// 16, unless the forces are falling, and does not grow until they have recovered, or until even the smallest
/// h has not helped: then steps begin with the first one again. Where steps repeat each other, h is limited
/// to a quarter, and the static form gets inertia.
class StepController {
 public:
  static constexpr double min_step_size = 1e-8;  ///< damping has failed below this h [s]
  static constexpr double max_step_size = 1e3;   ///< the largest h that growth leads to [s]

  struct State {
    double step_size = 0;       ///< h of the next step [s]
    int stall_count = 0;        ///< consecutive steps with forces far beyond the load; negative: without
    double stall_residual = 0;  ///< force residual of the first of these steps
    bool backed_off = false;    ///< h was reduced because of a stall and does not grow
    /// The largest h since steps have repeated each other [s]; without it the static form has no inertia.
    double cycle_limit = std::numeric_limits<double>::infinity();
  };
  /// At the beginning of a step.
  State state() const { return s_; }
  void restore(const State& state) { s_ = state; }

  explicit StepController(const NewtonParameters& parameters) : p_(parameters) { restart(); }
  /// Starts over, for another objective.
  void restart() { s_ = {p_.step_size}; }

  bool is_static() const { return p_.form == NewtonForm::statics; }
  double step_size() const { return s_.step_size; }  ///< h [s]
  double inverse_h2() const;                         ///< 1/h² [1/s²]; 0 for the static form without a limit
  /// Multiple of the masses that is added to the Hessian [1/s²].
  double mass_shift() const { return inverse_h2() + added_mass_; }

  void begin_step();
  /// Damps the step more, after a line search without descent. Returns false once h is too small, or the
  /// added mass too large, to try again.
  bool damp();
  /// Ends an iteration, whose line search found the step length α.
  void end_iteration(double step_length);
  /// Ends a step: adapts h to the step lengths and to stalls.
  void end_step(double force_residual);
  /// Limits h to a quarter of what it is, since steps repeat each other.
  void limit_step_size();
  /// Ends that limit, for another load.
  void end_limit() { s_.cycle_limit = std::numeric_limits<double>::infinity(); }
  /// Ends a step without descent: resets its damping.
  void abandon_step();

 private:
  const NewtonParameters& p_;
  State s_;
  double begun_with_ = 0;            // h at the beginning of the step [s]
  double shortest_step_length_ = 1;  // α of this step's iterations
  double added_mass_ = 0;            // of the static form, as 1/h² [1/s²]
};

}  // namespace drape
