// Runs that are stopped in the middle: by signals, politely and not, and by their observer.

#include "core/app/experiment/exit_codes.h"
#include "core/app/view/live_view.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/configs/resuming.h"
#include "tests/support/live_client.h"
#include "tests/support/solve.h"

namespace {

/// 30 × 30 vertices on 3 levels, to a tolerance that no state reaches, in steps so small that no level
/// stalls.
const std::string endless =
    "run e.yaml --out out --method all --threads 1 --set levels=3 --set cloth.columns=30 --set cloth.rows=30 "
    "--set newton.force_tolerance=1e-300 --set newton.step_size=2e-4 --set newton.step_growth=1 "
    "--set newton.max_steps=100000 ";

/// An endless run of the small experiment that has taken some steps.
struct EndlessRun : Scratch {
  explicit EndlessRun(const std::string& options = "")
      : Scratch(small_experiment()), command(endless + options, *this) {
    wait_for_steps(command, *this / "out", 5);
  }
  DrapeAtWork command;
};

/// Sends a signal and waits until it has been delivered: whatever the process is at, it must not finish that.
void deliver(Command& command, int signal) {
  command.send(signal);
  command.wait_until("the signal is delivered", [&] { return !command.has_pending(signal); });
}

const std::string stopped = "stopped on request; everything up to then is in out\n";

/// Asks to stop once that many levels have ended.
struct LevelLimit : drape::Observer {
  explicit LevelLimit(int levels) : left(levels) {}
  void level_finished(const drape::LevelResult&) override { --left; }
  bool stop_requested() override { return left <= 0; }
  int left;
};

}  // namespace

TEST_CASE("SIGINT ends a run after the step, with all results so far and the report") {
  EndlessRun run;
  const Ended ended = run.command.ended_by(SIGINT);
  CHECK(ended.exit_code == 130);
  CHECK(ended.out == "report: out/report.html\n");
  CHECK_THAT(ended.err, EndsWith(stopped));
  const nlohmann::json all = results_in(run / "out");
  CHECK(all["complete"] == false);
  REQUIRE(all["methods"].size() == 1);  // the next method is not begun
  REQUIRE(outcome_of_method(all["methods"]["pcs"]) == "cancelled: cancelled");
  CHECK(all["methods"]["pcs"]["levels"][0]["iterations"] >= 5);
  CHECK(drape::read_mesh(run / "out/levels/pcs_l0.ply").vertices.allFinite());
  CHECK(text_of(run / "out/report.html").ends_with("</html>\n"));
}

TEST_CASE("SIGTERM ends a run after the step where another library's thread receives it while METIS orders") {
  const Scratch folder(small_experiment());
  const std::string preloaded = (folders::test_plugins() / "../libsignal_in_ordering.so").string();
  const Ended ended =
      Command("exec env LD_PRELOAD=" + preloaded + " " + drape_command + " " + endless, folder.path).wait();
  CHECK(ended.exit_code == 143);
  CHECK_THAT(ended.err, EndsWith(stopped));
}

TEST_CASE("SIGHUP, as of a terminal that is closed, ends a run as SIGTERM does; under nohup it does not") {
  EndlessRun run;
  run.command.send(SIGHUP);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(run.command.ended_by(SIGHUP).exit_code == 129);  // from the system, once the shell has ended
  CHECK(fs::exists(run / "out/checkpoint/state.bin"));
  CHECK(fs::exists(run / "out/report.html"));
  fs::remove_all(run / "out");
  Command command("trap '' HUP; exec " + drape_command + " " + endless + " -q --no-report --measure",
                  run.path);
  wait_for_steps(command, run / "out", 5);
  command.send(SIGHUP);
  wait_for_steps(command, run / "out", static_cast<int>(lines_in(run / "out/iterations.csv")) + 20);
  CHECK(command.ended_by(SIGINT).exit_code == 130);
}

TEST_CASE("A run goes on where its standard streams are closed, and where nobody reads its progress") {
  const Scratch folder(small_experiment());
  const std::string run = drape_command + " run e.yaml --levels 1 --method pcs --no-report --measure ";
  REQUIRE(Command(run + "--out closed <&- >&- 2>&-", folder.path).wait().exit_code == 0);
  for (const auto& [name, bytes] : files_in(folder / "closed")) {
    INFO(name);
    CHECK_THAT(bytes, !Contains("pcs       level 0/0"));
  }
  Command("( " + run + "-v --out out 2>&1; echo $? > code ) | head -c 1", folder.path).wait();
  CHECK(text_of(folder / "code") == "0\n");
  CHECK(results_in(folder / "out")["complete"] == true);
}

TEST_CASE("An interrupted run is resumed although its results.json is damaged and its config.yaml is gone") {
  const bool between_renames = GENERATE(false, true);  // of a checkpoint's save
  EndlessRun run("--no-report --measure --quiet --checkpoint 0");
  run.command.ended_by(SIGKILL);
  run.write("out/results.json", "");
  const fs::path newest = run / "out/checkpoint/state.bin";
  if (between_renames && fs::exists(newest)) fs::rename(newest, run / "out/checkpoint/previous.bin");
  fs::remove(run / "out/config.yaml");
  DrapeAtWork resumed("run --resume out --quiet --no-report --measure", run);
  wait_for_lines(resumed, run / "out/iterations.csv", lines_in(run / "out/iterations.csv") + 4);
  CHECK(resumed.ended_by(SIGINT).exit_code == 130);
  CHECK(results_in(run / "out")["methods"]["pcs"]["status"] == "cancelled");
}

TEST_CASE("SIGKILL at any moment leaves complete files, sufficient for a report") {
  int levels_read = 0;
  // Few steps on few vertices, so that levels, metrics and methods follow fast on each other.
  const std::string fast = "--set newton.max_steps=3 --set cloth.columns=16 --set cloth.rows=16";
  for (const int level_lines : {1, 4, 7, 10, 13}) {
    const Scratch folder(small_experiment());
    DrapeAtWork command(endless + fast, folder);
    wait_for_lines(command, folder / "out/log.jsonl", level_lines);
    REQUIRE(command.ended_by(SIGKILL).exit_code == 128 + SIGKILL);

    const nlohmann::json all = results_in(folder / "out");
    CHECK(all["complete"] == false);
    if (!all["methods"].empty() && all["methods"].back()["status"] == "running")
      CHECK_THAT(drape_ends("table out --columns status,message", folder, drape::exit_not_converged).out,
                 Contains("running") && Contains("drape run --resume out goes on with it"));
    for (const auto& [name, method] : all["methods"].items())
      for (const nlohmann::json& level : method["levels"])
        CHECK(fs::exists(folder / ("out/" + level["mesh"].get<std::string>())));
    for (const auto& [name, bytes] : files_in(folder / "out")) {
      INFO(name);
      if (name.ends_with(".ply")) CHECK(drape::read_mesh(folder / "out" / name).vertices.allFinite());
      levels_read += name.starts_with("levels/") && name.ends_with(".ply");
      if (name.ends_with(".vtp") || name.ends_with(".pvd")) CHECK(bytes.ends_with("</VTKFile>\n"));
    }
    if (level_lines != 10) continue;
    drape_ends("report out --width 90", folder);
    drape_ends(endless, folder, 2);  // still somebody's results
    drape_ends(endless + "--overwrite --quiet --no-report --measure --levels 1 --set newton.max_steps=3",
               folder, 1);
    for (const auto& [name, bytes] : files_in(folder / "out")) CHECK_FALSE(name.ends_with(".part"));
  }
  CHECK(levels_read >= 8);
}

TEST_CASE("a second signal ends a run at once; SIGINT after SIGTERM, as of a sweep, lets it save its state") {
  EndlessRun twice, swept("--no-report --measure");
  deliver(twice.command, SIGTERM);
  const Ended at_once = twice.command.ended_by(SIGTERM);
  CHECK(at_once.exit_code == 128 + SIGTERM);
  CHECK(at_once.out == "");
  CHECK_THAT(at_once.err, !Contains("stopped on request"));
  deliver(swept.command, SIGTERM);
  const Ended saved = swept.command.ended_by(SIGINT);
  CHECK(saved.exit_code == 128 + SIGTERM);
  CHECK_THAT(saved.err, EndsWith(stopped));
}

TEST_CASE("a second signal ends a run at once while metrics and the report are made") {
  const Scratch folder(small_experiment());
  // A metric of neighbourhoods of thousands of vertices each, which takes seconds.
  DrapeAtWork command(
      "run e.yaml --measure --out out --method newton --threads 1 --levels 2 --set cloth.columns=75 --set "
      "cloth.rows=75 --set 'metrics=[{type: curvature_consistency, rings: 50}]' "
      "--set snapshots=0 --set newton.max_steps=2 --set newton.force_tolerance=1e9",
      folder);
  wait_for_lines(command, folder / "out/log.jsonl", 6);  // both levels have ended
  for (const int signal : {SIGTERM, SIGINT}) deliver(command, signal);
  CHECK(command.ended_by(SIGTERM).exit_code == 128 + SIGTERM);
  CHECK(results_in(folder / "out")["complete"] == false);
}

TEST_CASE("before a run has begun the first signal ends the process") {
  const Scratch folder(small_experiment());
  for (const std::string line : {"check e.yaml", "run e.yaml --out out"}) {
    INFO(line);
    DrapeAtWork command(line + " --allow-memory --levels 1 --set cloth.columns=2000 --set cloth.rows=2000",
                        folder);
    command.wait_until("it is at work", [&] { return command.processor_time() > 0.5; });
    const Ended ended = command.ended_by(SIGTERM);
    CHECK(ended.exit_code == 128 + SIGTERM);
    CHECK(ended.out == "");
    CHECK(!fs::exists(folder / "out"));
  }
}

TEST_CASE("a stop is heeded while the reference is solved, and a live view knows how its run ended") {
  for (const bool stops : {false, true}) {
    const Scratch folder;
    const Solved small =
        scene_from(small_experiment(), {{"reference", "{method: pcs, force_tolerance: 1e-9}"}});
    drape::RunOptions options = silent(folder / "run");
    options.methods = {"pcs"};
    LevelLimit limit(stops ? 2 : 1 << 20);  // all levels that the method has
    options.observer = &limit;
    drape::LiveView view(small.experiment, *small.scene, options.methods, 0);
    options.view = &view;
    run_experiment(small.experiment, *small.scene, options);
    CHECK(results_in(options.out)["complete"] == !stops);
    CHECK(outcome_of_method(results_in(options.out)["methods"]["pcs"]) == "converged: converged converged");
    const LiveAddress address(view.url());
    const LiveClient client(address.port);
    REQUIRE(
        client.send(address.request("GET", address.path + "news?version=0&rows=0", "Connection: close\r\n")));
    const std::string answer = client.answer();
    const auto news = nlohmann::json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
    CHECK_THAT(news["outcome"].get<std::string>(),
               StartsWith(stops ? "stopped on request; the results are in "
                                : "everything converged; the results are in "));
    CHECK(news["methods"][0]["levels"].size() == 2);
  }
}
