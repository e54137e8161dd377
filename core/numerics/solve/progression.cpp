#include "core/numerics/solve/progression.h"

#include <cmath>

#include "core/numerics/solve/newton_state.h"
#include "core/numerics/solve/safe_refinement.h"

namespace drape {

std::unique_ptr<Objective> Progression::objective(const Problem& problem, int level) const {
  return std::make_unique<PlainObjective>(problem.model(level));
}

std::vector<LevelResult> Progression::solve(const Problem& problem, Observer& observer) const {
  return resume(problem, MethodState(), observer);
}

std::vector<LevelResult> Progression::resume(const Problem& problem, const MethodState& from,
                                             Observer& observer) const {
  const Stopwatch clock(from.seconds);
  std::vector<LevelResult> results = from.finished;
  restore_load_stepping(problem, from);
  const int first = results.empty() ? std::max(from.level, first_level(problem)) : results.front().level;
  for (int l = std::max(from.level, first); l <= problem.finest(); ++l) {
    if (!results.empty() && results.back().outcome == Outcome::cancelled) break;
    const NewtonState* state = from.of(l);
    const bool anew = l == first || !refines();
    if (problem.load_stepping && !state) problem.load_stepping->begin(l, anew);
    LevelResult result;
    if (anew) {
      result.x = problem.starts[l];
    } else if (!state) {
      result = refine_safely(problem, l - 1, results.back().x,
                             problem.hierarchy.weights(interpolation())[l - 1], clock, observer);
      result.iterations = 0;  // the level's own are counted
      if (has_converged(result.outcome) &&
          !std::isfinite(problem.model(l)->energy_without_contact(result.x))) {
        result.outcome = Outcome::stalled;
        result.message = "the refined state is outside the domain of an energy";
      }
    }
    result.level = l;
    if (!state) observer.level_started(l);
    if (result.outcome == Outcome::stalled) {
      result.message += "; the level starts from the scene's start instead";
      result.x = problem.starts[l];
      result.outcome = {};
      if (problem.load_stepping) problem.load_stepping->begin(l, true);
    }
    if (result.outcome == Outcome::cancelled) {
      result.message = "stopped on request";
    } else {
      Positions start = std::move(result.x);
      LevelRun run{clock, observer, l < problem.finest(), result, state, problem.load_stepping.get()};
      run.hierarchy = &problem.hierarchy;
      if (!anew) run.stiffness = results.back().contact_stiffness;
      result = minimise(*objective(problem, l), std::move(start), newton, run);
      if (!anew && has_converged(result.outcome) && results.back().outcome == Outcome::infeasible) {
        result.outcome = Outcome::infeasible;
        result.message += (result.message.empty() ? "" : "; ") +
                          std::string("at equilibrium, but it began from level ") + std::to_string(l - 1) +
                          ", which had come to no end";
      }
    }
    result.from_initial_state = anew;
    results.push_back(std::move(result));
    observer.level_finished(results.back());
  }
  return results;
}

}  // namespace drape
