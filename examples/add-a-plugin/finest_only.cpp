#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/progression.h"

/// Newton on the finest level alone, from the scene's start.
struct FinestOnly : drape::Progression {
  static void declare(drape::Declaration<FinestOnly>& d) { declare_newton(d); }
  int first_level(const drape::Problem& problem) const override { return problem.finest(); }
};

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, FinestOnly>("finest_only", "Newton on the finest level alone.");
}
