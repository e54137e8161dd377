#include "core/numerics/solve/newton.h"

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/resumable_solver.h"

namespace drape {

/// Solves each level from the scene's start under its own energy (docs/theory/method.md, section 3).
class NewtonSolver : public ResumableSolver {
 public:
  struct Parameters {
    NewtonParameters newton;
    static void declare(Declaration<Parameters>& d) {
      d.add_section("newton", &Parameters::newton).description("settings of the Newton solves");
    }
  };
  explicit NewtonSolver(const Parameters& parameters) : p_(parameters) {}

  std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                  Observer& observer) const override {
    const Stopwatch clock(from.seconds);
    std::vector<LevelResult> results = from.finished;
    restore_load_stepping(problem, from);
    for (int l = from.level; l <= problem.finest(); ++l) {
      const NewtonState* state = from.of(l);
      if (!state) observer.level_started(l);
      if (problem.load_stepping && !state) problem.load_stepping->begin(l, true);
      PlainObjective objective(problem.model(l));
      LevelRun run{clock, observer, l < problem.finest(), {}, state, problem.load_stepping.get()};
      run.hierarchy = &problem.hierarchy;
      results.push_back(minimise(objective, problem.starts[l], p_.newton, run));
      results.back().from_initial_state = true;
      observer.level_finished(results.back());
      if (results.back().outcome == Outcome::cancelled) break;
    }
    return results;
  }

 private:
  Parameters p_;
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::NewtonSolver>(
      "newton", "Direct solve of every level on its own from the scene's start (C-IPC's implicit stepping).");
}
