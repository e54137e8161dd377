#pragma once

#include "core/numerics/solve/dirichlet_enforcer.h"
#include "core/numerics/step/newton_step.h"

namespace drape {

/// Moves the Dirichlet vertices of the iterate to their targets, and the whole cloth with them by a Newton
/// predictor. Where limits or contact stop that motion, it goes on after further steps (`in_parts`); where
/// they block it, the enforcer's penalty takes over.
///
/// Both motions need a factorisation. If it fails, nothing moves, and the step's factor().fault() says why.
class DirichletPredictor {
 public:
  /// Refers to all arguments but the last.
  DirichletPredictor(DirichletEnforcer& enforcer, Iterate& iterate, NewtonStep& step, bool in_parts)
      : enforcer_(enforcer), iterate_(iterate), step_(step), in_parts_(in_parts) {}

  /// Moves to new targets.
  void enforce();
  /// Continues a move that limits or contact stopped.
  void move_on();
  /// Near equilibrium under the penalty: moves Dirichlet vertices to their targets if nothing blocks them,
  /// else increases the penalty or declares them infeasible. Begins the penalty if there is none.
  void increase_penalty();
  /// Gives the enforcer's fixed vertices and penalty to the iterate.
  void update_constraints() { iterate_.set_constraints(enforcer_.fixed(), enforcer_.penalty()); }

 private:
  void begin_penalty();
  void begin_penalty_unless_moving(double fraction);
  double predict(bool whole, bool with_inertia);
  double move(bool whole);

  DirichletEnforcer& enforcer_;
  Iterate& iterate_;
  NewtonStep& step_;
  bool in_parts_;
};

}  // namespace drape
