#include "core/numerics/step/newton_parameters.h"

#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

void NewtonParameters::declare(Declaration<NewtonParameters>& d) {
  d.add_choice("form", &NewtonParameters::form,
               {{"quasistatic", NewtonForm::quasistatic}, {"static", NewtonForm::statics}},
               "damped gradient flow in implicit steps of h, or one minimisation (h infinite)")
      .source("PCS section 4; supplement, Figure 4");
  d.add("step_size", &NewtonParameters::step_size,
        "h of the first implicit step, and of the decrement; in the static form also the unit of the mass "
        "that damps a step without descent")
      .unit("s")
      .between(bounds::smallest_time_step, bounds::largest_time_step)
      .source("PCS section 4");
  d.add("step_growth", &NewtonParameters::step_growth,
        "factor on h after a full step, up to 1000 s; a step cut below a quarter divides h by it. With 1 h "
        "never grows, and stays as small as damping has made it")
      .between(1, 1e3)
      .source("departure from the paper");
  d.add("iterations_per_step", &NewtonParameters::iterations_per_step,
        "maximum Newton iterations of an implicit step; at least 30 where obstacles have just moved under "
        "friction")
      .between(1, 1000)
      .source("PCS section 4");
  d.add("max_steps", &NewtonParameters::max_steps,
        "maximum implicit steps of a level, or of each increment of a schedule")
      .between(1, 1e9);
  d.add("force_tolerance", &NewtonParameters::force_tolerance,
        "a level has converged when the net force on its free vertices is below this fraction of the load")
      .above(0)
      .at_most(1e12)
      .source("docs/theory/method.md section 2");
  d.add("decrement_tolerance", &NewtonParameters::decrement_tolerance,
        "also required of the largest of the last three decrements, ‖p‖ / (h √n) with the Newton direction p "
        "and the first step's h; 0 disables it")
      .unit("m/s")
      .between(0, 1e9)
      .source("Li et al. 2021 (C-IPC)");
  d.add_choice("projection", &NewtonParameters::projection,
               {{"clamp", Projection::clamp}, {"absolute", Projection::absolute}, {"none", Projection::none}},
               "treatment of negative eigenvalues of an element's Hessian")
      .source("Teran et al. 2005; Chen et al. 2024 for absolute");
  d.add_choice("psd_blend", &NewtonParameters::psd_blend,
               {{"full", PsdBlend::full}, {"adaptive", PsdBlend::adaptive}},
               "fraction of the projection in the matrix: full (projected Newton), or adaptive, which lowers "
               "it after full steps and raises it until the matrix is positive definite")
      .source("departure from the paper");
  d.add_choice(
       "linear_solver", &NewtonParameters::linear_solver,
       {{"automatic", LinearSolver::automatic},
        {"multigrid", LinearSolver::multigrid},
        {"mixed", LinearSolver::mixed},
        {"supernodal", LinearSolver::supernodal},
        {"cholmod", LinearSolver::cholmod}},
       "automatic: multigrid on levels of 20,000 vertices and more below which there are coarser ones, mixed "
       "on others. multigrid: conjugate gradients with V-cycles over the hierarchy's meshes; where that "
       "fails, mixed. mixed: conjugate gradients with drape's Cholesky factor in single precision. "
       "supernodal: that factor in double precision. cholmod: CHOLMOD's, by the installed BLAS")
      .source("docs/results/speed.md; Chen et al. 2008 for cholmod");
  d.add_choice(
       "stability", &NewtonParameters::stability,
       {{"leave", StabilityMode::leave}, {"report", StabilityMode::report}, {"off", StabilityMode::off}},
       "what becomes of an equilibrium that is a saddle. leave: the cloth moves along its least stable "
       "motion and is solved again; after ten exits a level ends as `saddle`. report: it does so at its "
       "first saddle. off: no equilibrium is tested")
      .source("docs/theory/method.md section 2");
}

}  // namespace drape
