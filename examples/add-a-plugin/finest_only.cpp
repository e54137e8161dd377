#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/newton.h"

namespace {

/// Newton on the finest level alone, from the scene's start.
struct FinestOnly : drape::Solver {
  drape::NewtonParameters newton;

  static void declare(drape::Declaration<FinestOnly>& d) {
    d.add_section("newton", &FinestOnly::newton).description("settings of the Newton solve");
  }

  std::vector<drape::LevelResult> solve(const drape::Problem& problem,
                                        drape::Observer& observer) const override {
    const drape::Stopwatch clock;
    const int finest = problem.finest();
    observer.level_started(finest);
    drape::PlainObjective objective(problem.model(finest));
    drape::LevelResult result = drape::minimise(objective, problem.starts[finest], newton, {clock, observer});
    result.from_initial_state = true;
    observer.level_finished(result);
    return {result};
  }
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, FinestOnly>("finest_only", "Newton on the finest level alone.");
}
