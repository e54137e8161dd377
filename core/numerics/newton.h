#pragma once

#include <functional>

#include "core/model/objective.h"
#include "core/model/solver.h"
#include "core/numerics/newton_parameters.h"
#include "core/numerics/stopwatch.h"

namespace drape {

/// The part of a method that one minimisation is.
struct LevelRun {
  const Stopwatch& clock;  ///< the method's, for the rows that the observer gets
  Observer& observer;
  bool finer_follows = false;  ///< the level may be refined early, as the observer or the parameters ask
  std::map<std::string, double> spent = {};  ///< on the level before this, by phase [s]
  const NewtonState* from = nullptr;  ///< where an earlier minimisation of the same was, to go on there
  Conditions* conditions = nullptr;   ///< that change meanwhile
  std::string remark = {};            ///< what the result's message begins with
  /// The force residual that a state of this level leaves on the next one; 0 where it is not allowed there.
  std::function<double(const Positions& x)> residual_above = {};
};

/// Minimises the objective from x, where fixed vertices stay, step by implicit step
///   x^{t+1} = argmin 1/(2h²) ‖x − x^t‖²_M + F(x),
/// with a filtered line search. Where the run has a state to go on from, x is that state's. Conditions that
/// have begun on the level are gone through to the last. Ends `infeasible`, the rest of the cloth at
/// equilibrium, where held vertices or obstacles cannot reach their places.
LevelResult minimise(Objective& objective, Positions x, const NewtonParameters& parameters,
                     const LevelRun& run);

}  // namespace drape
