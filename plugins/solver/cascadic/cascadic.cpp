#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/progression.h"

namespace drape {

/// Solves coarse to fine, each level under its own energy, in the style of Sensitive Couture (Umetani et al.
/// 2011). The finest level is plain Newton from a better start.
struct CascadicSolver : Progression {
  Interpolation prolongation = Interpolation::midpoint;

  static void declare(Declaration<CascadicSolver>& d) {
    d.add_choice(
         "prolongation", &CascadicSolver::prolongation,
         {{"midpoint", Interpolation::midpoint}, {"refiner", Interpolation::refiner}},
         "prolongs a level's state: linearly over the rest shape, on grids by edge midpoints, or by the "
         "experiment's refiner")
        .source("docs/theory/method.md section 3");
    declare_newton(d);
  }

  Interpolation interpolation() const override { return prolongation; }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::CascadicSolver>(
      "cascadic", "Coarse to fine, each level under its own energy (style of Sensitive Couture).");
}
