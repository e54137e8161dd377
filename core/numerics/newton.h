#pragma once

#include "core/model/objective.h"
#include "core/model/solver.h"
#include "core/numerics/stopwatch.h"
#include "core/plugin/parameters.h"

namespace drape {

/// Whether a level is solved by damped gradient flow or by one minimisation (docs/method.md, sections 2, 3).
enum class NewtonForm { quasistatic, statics };

/// How much of the projection goes into the matrix.
enum class ProjectionShare {
  full,  ///< all of it, in every step
  least  ///< in every step the smallest of a few shares that leaves the matrix positive definite
};

/// Settings of the one Newton, the same for every method so that comparisons compare methods.
struct NewtonParameters {
  NewtonForm form = NewtonForm::quasistatic;
  double step_size = 0.1;
  double step_growth = 1.5;
  double step_size_limit = 1e3;
  int iterations_per_step = 1;
  int max_steps = 5000;
  double force_tolerance = 1e-3;
  double decrement_tolerance = 0;
  Projection::Kind projection = Projection::clamp;
  ProjectionShare projection_share = ProjectionShare::least;
  int refresh = 1;

  static void declare(Declaration<NewtonParameters>& d);
};

/// The part of a method that one minimisation is.
struct LevelRun {
  const Stopwatch& clock;  ///< the method's, for the rows that the observer gets
  Observer& observer;
  bool finer_follows = false;                ///< the observer may ask for the finer level early
  std::map<std::string, double> spent = {};  ///< on the level before this, by phase [s]
  const NewtonState* from = nullptr;  ///< where an earlier minimisation of the same was, to go on there
  Conditions* conditions = nullptr;   ///< that change meanwhile
  bool afresh = false;                ///< as LevelResult has it
  std::string remark = {};            ///< what the result's message begins with
};

/// Minimises the objective from x, where fixed vertices stay, step by implicit step
///   x^{t+1} = argmin 1/(2h²) ‖x − x^t‖²_M + F(x),
/// with a filtered line search. Where the run has a state to go on from, x is that state's. Conditions that
/// have begun on the level are gone through to the last. Ends `infeasible`, the rest of the cloth at
/// equilibrium, where held vertices or obstacles cannot reach their places.
LevelResult minimise(Objective& objective, Positions x, const NewtonParameters& parameters,
                     const LevelRun& run);

}  // namespace drape
