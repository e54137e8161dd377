#include "core/numerics/progression.h"

#include "core/numerics/safe_refinement.h"

namespace drape {

std::vector<LevelResult> solve_progressively(
    const Problem& problem, const std::vector<ProlongationMatrix>& weights,
    const std::function<std::unique_ptr<Objective>(int level)>& objective, const NewtonParameters& newton,
    Observer& observer) {
  const Stopwatch clock;
  std::vector<LevelResult> results;
  Refined start;
  start.x = problem.starts[0];
  if (problem.conditions) problem.conditions->begin(0, true);
  for (int l = 0; l <= problem.finest(); ++l) {
    observer.level_started(l);
    LevelResult result;
    if (start.fault.empty()) {
      result = minimise(*objective(l), std::move(start.x), newton, clock, observer, l < problem.finest(),
                        problem.conditions);
    } else {
      result.x = std::move(start.x);
      result.outcome = Outcome::infeasible;
      result.message = start.fault;
    }
    result.level = l;
    result.afresh = l == 0;
    if (l > 0) {
      result.seconds += start.seconds;
      result.seconds_by_phase["refinement"] = start.seconds;
    }
    results.push_back(std::move(result));
    observer.level_finished(results.back());
    if (results.back().outcome == Outcome::cancelled || !start.fault.empty()) break;
    if (l == problem.finest()) break;
    if (problem.conditions) problem.conditions->begin(l + 1, false);
    start = refine_safely(problem, l, results.back().x, weights[l], clock, observer);
  }
  return results;
}

}  // namespace drape
