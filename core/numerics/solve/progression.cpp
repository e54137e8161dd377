#include "core/numerics/solve/progression.h"

#include "core/numerics/solve/newton_state.h"
#include "core/numerics/solve/safe_refinement.h"

namespace drape {

std::vector<LevelResult> solve_progressively(
    const Problem& problem, const std::vector<ProlongationMatrix>& weights,
    const std::function<std::unique_ptr<Objective>(int level)>& objective, const NewtonParameters& newton,
    const MethodState& from, Observer& observer) {
  const Stopwatch clock(from.seconds);
  std::vector<LevelResult> results = from.finished;
  restore_load_stepping(problem, from);
  const int first = results.empty() ? from.level : results.front().level;
  for (int l = from.level; l <= problem.finest(); ++l) {
    if (!results.empty() && results.back().outcome == Outcome::cancelled) break;
    const NewtonState* state = from.of(l);
    if (problem.load_stepping && !state) problem.load_stepping->begin(l, l == first);
    Refined start;
    if (l == first)
      start.x = problem.starts[l];
    else if (!state)
      start = refine_safely(problem, l - 1, results.back().x, weights[l - 1], clock, observer);
    LevelResult result;
    result.level = l;
    if (!state) observer.level_started(l);
    std::map<std::string, double> spent;
    if (l > first) spent["refinement"] = start.seconds;
    std::string remark;
    if (!start.fault.empty()) {
      remark = start.fault + "; the level starts from the scene's start instead";
      start.x = problem.starts[l];
      if (problem.load_stepping) problem.load_stepping->begin(l, true);
    }
    if (start.cancelled) {
      result.x = std::move(start.x);
      result.outcome = Outcome::cancelled;
      result.message = "stopped on request";
      result.seconds = start.seconds;
      result.seconds_by_phase = spent;
    } else {
      LevelRun run{clock, observer, l < problem.finest(), spent, state, problem.load_stepping.get(), remark};
      run.hierarchy = &problem.hierarchy;
      if (!results.empty()) run.stiffness = results.back().contact_stiffness;
      result = minimise(*objective(l), std::move(start.x), newton, run);
    }
    result.from_initial_state = l == first;
    results.push_back(std::move(result));
    observer.level_finished(results.back());
  }
  return results;
}

}  // namespace drape
