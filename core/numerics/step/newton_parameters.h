#pragma once

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/declaration.h"
#include "core/numerics/linear_algebra/numeric_factor.h"

namespace drape {

/// Damped gradient flow in implicit steps, or one minimisation (docs/theory/method.md, sections 2, 3).
enum class NewtonForm { quasistatic, statics };

/// How much of the PSD projection of element Hessians goes into the Newton matrix.
enum class PsdBlend {
  full,     ///< all of it, in every iteration (projected Newton)
  adaptive  ///< as little as keeps the matrix positive definite (HessianModification)
};

/// What becomes of an equilibrium that is not a minimum.
enum class StabilityMode { leave, report, off };

/// Settings of the Newton solver. All methods share one implementation, so their comparison compares methods.
struct NewtonParameters {
  NewtonForm form = NewtonForm::quasistatic;
  double step_size = 0.1;
  double step_growth = 1.5;
  int iterations_per_step = 1;
  int max_steps = 5000;
  double force_tolerance = 1e-3;
  double decrement_tolerance = 0;
  Projection::Kind projection = Projection::clamp;
  PsdBlend psd_blend = PsdBlend::adaptive;
  LinearSolver linear_solver = LinearSolver::automatic;
  StabilityMode stability = StabilityMode::leave;

  static void declare(Declaration<NewtonParameters>& d);
};

}  // namespace drape
