#pragma once

#include "core/kernel/solve/dirichlet_enforcer.h"
#include "core/kernel/solve/newton_step.h"

namespace drape {

/// Moves the Dirichlet vertices of the iterate to their targets, and the whole cloth with them by a Newton
/// predictor. Where limits or contact block that motion, the enforcer's penalty takes over.
///
/// Both motions need a factorisation. If it fails, nothing moves, and the step's factor().fault() says why.
class DirichletPredictor {
 public:
  /// Refers to all arguments.
  DirichletPredictor(DirichletEnforcer& enforcer, Iterate& iterate, NewtonStep& step)
      : enforcer_(enforcer), iterate_(iterate), step_(step) {}

  /// Moves to new targets.
  void enforce();
  /// Near equilibrium under the penalty: moves Dirichlet vertices to their targets if nothing blocks them,
  /// else increases the penalty or declares them infeasible.
  void increase_penalty();
  /// Gives the enforcer's fixed vertices and penalty to the iterate.
  void update_constraints() { iterate_.set_constraints(enforcer_.fixed(), enforcer_.penalty()); }

 private:
  double predict(bool whole);
  double move(bool whole);

  DirichletEnforcer& enforcer_;
  Iterate& iterate_;
  NewtonStep& step_;
};

}  // namespace drape
