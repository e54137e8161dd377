#pragma once

#include "core/app/report/run_data.h"
#include "tests/configs/resuming.h"
#include "tests/support/solve.h"

/// Runs the experiment in a folder, whole and killed in each of these phases, and checks that it resumes to
/// the same bits.
inline void check_killed_in(const Scratch& folder, const std::vector<std::string>& phases) {
  using namespace drape;
  const Experiment experiment = experiment_in(folder / "e.yaml");
  run_experiment(experiment, *scene_of(experiment), silent(folder / "whole"));
  std::map<std::string, int> steps;  // at the end of each phase
  int all = 0;
  const Json whole = read_results(folder / "whole");
  for (const auto& row : whole["methods"]["newton"]["increments"]) {
    all += row["steps"].get<int>();
    if (row.contains("phase")) steps[row["phase"]] = all;
  }
  for (const std::string& phase : phases) {
    INFO(phase);
    REQUIRE(steps.contains(phase));
    RunOptions options = silent(folder / phase);
    options.checkpoint = 0;
    int polled = 0;
    options.stop = [&] { return ++polled > steps[phase] - 1; };  // asked at every step
    run_experiment(experiment, *scene_of(experiment), options);
    REQUIRE_FALSE(is_complete(folder / phase));
    std::vector<std::string> warnings;
    ConfigErrors errors;
    auto saved = read_saved_run(folder / phase, test_registry(), LargeMemory::allowed, warnings, errors);
    throw_errors(errors);
    REQUIRE(saved->interrupted);
    resume_experiment(saved->experiment, *saved->scene, silent(folder / phase),
                      std::move(*saved->interrupted));
    check_equal(folder / phase, folder / "whole");
  }
}
