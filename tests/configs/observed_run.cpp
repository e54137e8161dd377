// A run's observer sees what is recorded, and may stop the run or refine a level.

#include <catch2/catch.hpp>

#include "core/app/report/run_data.h"
#include "core/app/run/runner.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"
#include "tests/support/registry.h"

using namespace drape;
namespace fs = std::filesystem;

namespace {

struct Watch : Observer {
  int iterations = 0, levels = 0, most = 1 << 20, refine_after = 1 << 20;
  Positions last;
  void iteration(const IterationRow&, const Positions& x) override {
    ++iterations;
    last = x;
  }
  void level_finished(const LevelResult&) override { ++levels; }
  bool stop_requested() override { return iterations >= most; }
  bool refine_requested() override { return levels == 0 && iterations >= refine_after; }
};

/// The run's record; `watch` sees it.
RunData run_with(Watch& watch) {
  const Scratch folder;
  ConfigErrors errors;
  const auto experiment = read_experiment(fs::path(folders::source()) / "tests/configs/data/small.yaml", {},
                                          test_registry(), errors);
  throw_errors(errors);
  const auto scene = build_scene(*experiment, errors);
  throw_errors(errors);
  RunOptions options;
  options.out = folder / "run";
  options.methods = {"pcs"};
  options.verbosity = Verbosity::quiet;
  options.report = false;
  options.observer = &watch;
  run_experiment(*experiment, *scene, options);
  return read_run(options.out);
}

}  // namespace

TEST_CASE("an observer sees every iteration and level of a run") {
  Watch watch;
  const RunData run = run_with(watch);
  CHECK(run.complete);
  std::size_t rows = 0;
  for (const IterationSeries& series : run.iterations) rows += series.rows.size();
  CHECK(rows > 4);
  CHECK(static_cast<std::size_t>(watch.iterations) == rows);
  CHECK(watch.levels == 2);
}

TEST_CASE("an observer stops a run") {
  Watch watch;
  watch.most = 2;
  const RunData run = run_with(watch);
  CHECK_FALSE(run.complete);
  CHECK(watch.iterations == 2);
  CHECK(run.methods.at(0).levels.at(0).status == "cancelled");
}

TEST_CASE("an observer refines a level") {
  Watch watch;
  watch.refine_after = 1;
  const RunData run = run_with(watch);
  CHECK(run.methods.at(0).levels.at(0).status == "refined_early_on_request");
  CHECK(run.methods.at(0).levels.size() == 2);
}
