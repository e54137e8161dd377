#pragma once

#include "core/model/energy.h"
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
  double refine_at = 0;
  double refine_ratio = 0;
  Projection::Kind projection = Projection::clamp;
  ProjectionShare projection_share = ProjectionShare::least;
  int refresh = 1;

  static void declare(Declaration<NewtonParameters>& d);
};

}  // namespace drape
