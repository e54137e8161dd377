// A run's observer sees what is recorded, and may stop the run.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/report/run_data.h"
#include "core/app/run/runner.h"
#include "core/app/view/live_view.h"
#include "tests/support/command.h"
#include "tests/support/live_client.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

struct Watch : Observer {
  int iterations = 0, levels = 0, most = 1 << 20, most_levels = 1 << 20;
  void iteration(const IterationRow&, const Positions&) override { ++iterations; }
  void level_finished(const LevelResult&) override { ++levels; }
  bool stop_requested() override { return iterations >= most || levels >= most_levels; }
};

/// How a run ended, by its record and by its live view.
struct Observed {
  RunData data;
  std::string shown;
  std::size_t levels_shown;
};

/// Runs an experiment, which `watch` sees.
Observed observed(Watch& watch, const Overrides& overrides = {}) {
  const Scratch folder;
  const Solved small = scene_from(small_experiment(), overrides);
  RunOptions options;
  options.out = folder / "run";
  options.methods = {"pcs"};
  options.verbosity = Verbosity::quiet;
  options.report = false;
  options.observer = &watch;
  LiveView view(small.experiment, *small.scene, options.methods, 0);
  options.view = &view;
  run_experiment(small.experiment, *small.scene, options);
  const LiveAddress address(view.url());
  const LiveClient client(address.port);
  REQUIRE(
      client.send(address.request("GET", address.path + "news?version=0&rows=0", "Connection: close\r\n")));
  const std::string answer = client.answer();
  const auto news = nlohmann::json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  return {read_run(options.out), news["outcome"], news["methods"][0]["levels"].size()};
}

}  // namespace

TEST_CASE(
    "an observer sees every iteration and level of a run, which ends with its outcome on the live view") {
  Watch watch;
  const Observed run = observed(watch);
  CHECK(run.data.complete);
  CHECK(run.data.iterations.size() > 4);
  CHECK(static_cast<std::size_t>(watch.iterations) == run.data.iterations.size());
  CHECK(watch.levels == 2);
  CHECK(run.shown.starts_with("everything converged; the results are in "));
  CHECK(run.levels_shown == 2);  // which nobody asked for while it ran
}

TEST_CASE("an observer stops a run") {
  Watch watch;
  watch.most = 2;
  const RunData run = observed(watch).data;
  CHECK_FALSE(run.complete);
  CHECK(watch.iterations == 2);
  CHECK(run.methods.at(0).levels.at(0).status == "cancelled");
}

TEST_CASE("a request to stop is heeded while the reference is solved and errors are measured") {
  Watch watch;
  watch.most_levels = 2;  // all that the method has
  const Observed run = observed(watch, {{"reference", "{method: pcs, force_tolerance: 1e-9}"}});
  CHECK(run.data.methods.at(0).status == "converged");
  CHECK_FALSE(run.data.complete);
  CHECK(run.shown.starts_with("stopped on request; the results are in "));
}
