#pragma once

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/objective.h"
#include "core/numerics/step/newton_parameters.h"

namespace drape {

/// Context of one minimisation within a method.
struct LevelRun {
  const Stopwatch& clock;  ///< the method's, for the observer's rows
  Observer& observer;
  bool finer_follows = false;             ///< the level may be refined early, on request
  LevelResult before = {};                ///< costs of the level so far, and how its message begins
  const NewtonState* from = nullptr;      ///< state to resume from; null to begin
  LoadStepping* load_stepping = nullptr;  ///< null without a schedule
  ContactStiffness stiffness = {};        ///< at least this of each contact model [Pa]
  const Hierarchy* hierarchy = nullptr;   ///< of the level, for LinearSolver::multigrid; may be null
};

/// Minimises the objective F from x (n×3) [m] by implicit steps
///   x^{t+1} = argmin 1/(2h²) ‖x − x^t‖²_M + F(x)
/// with a filtered line search; fixed vertices stay. If the run has a state to resume from, x is ignored.
/// Load stepping that has begun on the level is carried through all its increments. If obstacles or, in the
/// last increment, Dirichlet vertices cannot reach their targets, the rest of the cloth is solved and the
/// result is `infeasible`. The message names the first earlier increment whose targets were not reached.
LevelResult minimise(Objective& objective, Positions x, const NewtonParameters& parameters,
                     const LevelRun& run);

}  // namespace drape
