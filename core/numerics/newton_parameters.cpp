#include "core/numerics/newton_parameters.h"

#include "core/plugin/bounds.h"

namespace drape {

void NewtonParameters::declare(Declaration<NewtonParameters>& d) {
  d.add_choice("form", &NewtonParameters::form,
               {{"quasistatic", NewtonForm::quasistatic}, {"static", NewtonForm::statics}})
      .description("damped gradient flow in steps of h, or one minimisation (h infinite)")
      .source("PCS section 4; supplement, Figure 4");
  d.add("step_size", &NewtonParameters::step_size)
      .unit("s")
      .at_least(bounds::smallest_time_step)
      .at_most(bounds::largest_time_step)
      .description("h of the first implicit step; the static form uses it for the decrement alone")
      .source("PCS section 4");
  d.add("step_growth", &NewtonParameters::step_growth)
      .at_least(1)
      .at_most(1e3)
      .description("factor on h after a step taken in full; one cut below a quarter divides it. 1 keeps h")
      .source("departure from the paper");
  d.add("step_size_limit", &NewtonParameters::step_size_limit)
      .unit("s")
      .at_least(bounds::smallest_time_step)
      .at_most(bounds::largest_time_step)
      .description("h grows no further");
  d.add("iterations_per_step", &NewtonParameters::iterations_per_step)
      .at_least(1)
      .at_most(1000)
      .description("Newton iterations an implicit step may take")
      .source("PCS section 4");
  d.add("max_steps", &NewtonParameters::max_steps)
      .at_least(1)
      .at_most(1e9)
      .description("steps a level may take");
  d.add("force_tolerance", &NewtonParameters::force_tolerance)
      .above(0)
      .at_most(1e12)
      .description(
          "a level is converged when the net force on its free vertices is below this part of the load")
      .source("docs/method.md section 2");
  d.add("decrement_tolerance", &NewtonParameters::decrement_tolerance)
      .unit("m/s")
      .at_least(0)
      .at_most(1e9)
      .description("also asked of the largest of the last three decrements; 0 asks nothing")
      .source("Li et al. 2021 (C-IPC)");
  d.add("refine_at", &NewtonParameters::refine_at)
      .at_least(0)
      .at_most(1e12)
      .description(
          "a level whose state a finer one goes on from is left once its force residual is below this; "
          "0 waits for equilibrium, and so does a schedule")
      .source("PCS section 4: a level may be refined before it has converged");
  d.add("refine_ratio", &NewtonParameters::refine_ratio)
      .at_least(0)
      .at_most(1e3)
      .description(
          "a level whose state a finer one goes on from is left once its force residual is below this part "
          "of the residual that the state leaves there; 0 waits for equilibrium, and so does a schedule")
      .source("nested iteration: Hackbusch 1985, chapter 5; a departure from the paper");
  d.add_choice("projection", &NewtonParameters::projection,
               {{"clamp", Projection::clamp}, {"absolute", Projection::absolute}, {"none", Projection::none}})
      .description("what becomes of negative eigenvalues of an element's Hessian")
      .source("Teran et al. 2005; Chen et al. 2024 for absolute");
  d.add_choice("projection_share", &NewtonParameters::projection_share,
               {{"full", ProjectionShare::full}, {"least", ProjectionShare::least}})
      .description(
          "how much of the projection is made: full, or the least of a few shares that leaves the matrix "
          "positive definite, which tends to the exact Hessian near an equilibrium")
      .source("departure from the paper");
  d.add("refresh", &NewtonParameters::refresh)
      .at_least(1)
      .at_most(1e6)
      .description("iterations that share one matrix and its factor")
      .source("departure from the paper");
}

}  // namespace drape
