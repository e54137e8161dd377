// Runs that are stopped in the middle, politely and not.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/experiment/exit_codes.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/command.h"

namespace fs = std::filesystem;

namespace {

/// 30 × 30 vertices on 3 levels, to a tolerance that no state reaches, in steps so small that no level
/// stalls.
const std::string endless =
    "run e.yaml --out out --method all --threads 1 --set levels=3 --set cloth.columns=30 --set cloth.rows=30 "
    "--set newton.force_tolerance=1e-300 --set newton.step_size=2e-4 --set newton.step_growth=1 "
    "--set newton.max_steps=100000 ";

}  // namespace

TEST_CASE("SIGINT ends a run after the step, with all results so far and the report") {
  const Scratch folder(small_experiment());
  DrapeAtWork command(endless, folder);
  wait_for_lines(command, folder / "out/iterations.csv", 6);
  const Ended ended = command.ended_by(SIGINT);
  CHECK(ended.exit_code == 130);
  CHECK(ended.out == "report: out/report.html\n");
  CHECK_THAT(ended.err, Catch::EndsWith("stopped on request; everything up to then is in out\n"));
  const nlohmann::json all = json_in(folder / "out/results.json");
  CHECK(all["complete"] == false);
  REQUIRE(all["methods"].size() == 1);  // the next method is not begun
  const nlohmann::json& pcs = all["methods"]["pcs"];
  CHECK(pcs["status"] == "cancelled");
  REQUIRE(pcs["levels"].size() == 1);
  CHECK(pcs["levels"][0]["status"] == "cancelled");
  CHECK(pcs["levels"][0]["iterations"].get<int>() >= 5);
  CHECK(drape::read_mesh(folder / "out/levels/pcs_l0.ply").vertices.allFinite());
  CHECK(text_of(folder / "out/report.html").ends_with("</html>\n"));
}

TEST_CASE("SIGHUP, as of a terminal that is closed, ends a run as SIGTERM does; under nohup it does not") {
  const Scratch folder(small_experiment());
  {
    DrapeAtWork command(endless, folder);
    wait_for_lines(command, folder / "out/iterations.csv", 6);
    command.send(SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(command.ended_by(SIGHUP).exit_code == 129);  // from the system, once the shell has ended
  }
  CHECK(fs::exists(folder / "out/checkpoint/state.bin"));
  CHECK(fs::exists(folder / "out/report.html"));
  fs::remove_all(folder / "out");
  Command command("trap '' HUP; exec " + drape_command + " " + endless + " -q --no-report", folder.path);
  wait_for_lines(command, folder / "out/iterations.csv", 6);
  command.send(SIGHUP);
  wait_for_lines(command, folder / "out/iterations.csv", lines_in(folder / "out/iterations.csv") + 20);
  CHECK(command.ended_by(SIGINT).exit_code == 130);
}

TEST_CASE("A run writes nothing of its progress into its files where the standard streams are closed") {
  const Scratch folder(small_experiment());
  DrapeAtWork command("run e.yaml --levels 1 --method pcs --no-report --out out <&- >&- 2>&-", folder);
  REQUIRE(command.wait().exit_code == 0);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out")) {
    if (!entry.is_regular_file()) continue;
    INFO(entry.path());
    CHECK_THAT(text_of(entry.path()), !Catch::Contains("pcs       level 0/0"));
  }
}

TEST_CASE("A run goes on where nobody reads its progress") {
  const Scratch folder(small_experiment());
  Command command(
      "( " + drape_command +
          " run e.yaml --levels 1 --method pcs --no-report -v --out out 2>&1; echo $? > code ) | head -c 1",
      folder.path);
  command.wait();
  CHECK(text_of(folder / "code") == "0\n");
  CHECK(json_in(folder / "out/results.json")["complete"] == true);
}

TEST_CASE("An interrupted run is resumed although its results.json is damaged and its config.yaml is gone") {
  const bool between_renames = GENERATE(false, true);  // of a checkpoint's save
  const Scratch folder(small_experiment());
  DrapeAtWork command(
      "run e.yaml --out out --threads 1 --no-report --quiet --method pcs --checkpoint 0 "
      "--set newton.max_steps=100000 --set newton.force_tolerance=1e-300",
      folder);
  wait_for_lines(command, folder / "out/iterations.csv", 6);
  command.ended_by(SIGKILL);
  std::ofstream(folder / "out/results.json") << "";
  const fs::path newest = folder / "out/checkpoint/state.bin";
  if (between_renames && fs::exists(newest)) fs::rename(newest, folder / "out/checkpoint/previous.bin");
  fs::remove(folder / "out/config.yaml");
  DrapeAtWork resumed("run --resume out --quiet --no-report", folder);
  wait_for_lines(resumed, folder / "out/iterations.csv", lines_in(folder / "out/iterations.csv") + 4);
  CHECK(resumed.ended_by(SIGINT).exit_code == 130);
  CHECK(json_in(folder / "out/results.json")["methods"]["pcs"]["status"] == "cancelled");
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

    const nlohmann::json all = json_in(folder / "out/results.json");
    CHECK(all["complete"] == false);
    if (!all["methods"].empty() && all["methods"].back()["status"] == "running")
      CHECK_THAT(drape_ends("table out --columns status,message", folder, drape::exit_not_converged).out,
                 Catch::Contains("running") && Catch::Contains("drape run --resume out goes on with it"));
    for (const auto& [name, method] : all["methods"].items())
      for (const nlohmann::json& level : method["levels"])
        CHECK(fs::exists(folder / ("out/" + level["mesh"].get<std::string>())));
    for (const auto& entry : fs::recursive_directory_iterator(folder / "out")) {
      INFO(entry.path());
      const std::string extension = entry.path().extension();
      if (extension == ".ply") {
        CHECK(drape::read_mesh(entry.path()).vertices.allFinite());
        levels_read += entry.path().parent_path().filename() == "levels";
      }
      if (extension == ".vtp" || extension == ".pvd") CHECK(text_of(entry.path()).ends_with("</VTKFile>\n"));
    }
    if (level_lines != 10) continue;
    drape_ends("report out --width 90", folder);
    drape_ends(endless, folder, 2);  // still somebody's results
    drape_ends(endless + "--overwrite --quiet --no-report --levels 1 --set newton.max_steps=3", folder, 1);
    for (const auto& entry : fs::recursive_directory_iterator(folder / "out"))
      CHECK(entry.path().extension() != ".part");
  }
  CHECK(levels_read >= 8);
}

namespace {

/// Sends SIGTERM, and again as soon as it has been delivered: whatever the process is at, it must not finish
/// that.
Ended ended_by_two_signals(Command& command, int between = SIGTERM) {
  for (const int signal : {SIGTERM, between}) {
    command.send(signal);
    command.wait_until("the signal is delivered", [&] { return !command.has_pending(signal); });
    if (between == SIGTERM) break;
  }
  return command.ended_by(SIGTERM);
}

}  // namespace

TEST_CASE("a second signal ends a run at once") {
  const Scratch folder(small_experiment());
  DrapeAtWork command(endless, folder);
  wait_for_lines(command, folder / "out/iterations.csv", 6);
  const Ended ended = ended_by_two_signals(command);
  CHECK(ended.exit_code == 128 + SIGTERM);
  CHECK(ended.out == "");
  CHECK_THAT(ended.err, !Catch::Contains("stopped on request"));
}

TEST_CASE("a second signal ends a run at once while metrics and the report are made") {
  const Scratch folder(small_experiment());
  // A metric of neighbourhoods of thousands of vertices each, which takes seconds.
  DrapeAtWork command(
      "run e.yaml --out out --method newton --threads 1 --levels 2 --set cloth.columns=75 --set "
      "cloth.rows=75 --set 'metrics=[{type: curvature_consistency, rings: 50}]' "
      "--set snapshots=0 --set newton.max_steps=2 --set newton.force_tolerance=1e9",
      folder);
  wait_for_lines(command, folder / "out/log.jsonl", 6);  // both levels have ended
  CHECK(ended_by_two_signals(command, SIGINT).exit_code == 128 + SIGTERM);
  CHECK(json_in(folder / "out/results.json")["complete"] == false);
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

TEST_CASE("a run that is sent SIGTERM, and then SIGINT by its sweep, still saves its state") {
  const Scratch folder(small_experiment());
  DrapeAtWork command(endless + "--no-report", folder);
  wait_for_lines(command, folder / "out/iterations.csv", 6);
  command.send(SIGTERM);
  command.wait_until("the signal is delivered", [&] { return !command.has_pending(SIGTERM); });
  const Ended ended = command.ended_by(SIGINT);
  CHECK(ended.exit_code == 128 + SIGTERM);
  CHECK_THAT(ended.err, Catch::EndsWith("stopped on request; everything up to then is in out\n"));
}
