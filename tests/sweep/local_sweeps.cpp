// Sweeps on this machine: same results however many workers, continued where cut, nothing run twice.

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/kernel/threads/parallel.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"
#include "tests/support/sweep_runs.h"

namespace fs = std::filesystem;
using Catch::Contains;

namespace {

const std::string small_sweep =
    "sweep " + (folders::source() / "tests/sweep/small_sweep.yaml").string() + " ";

/// Waits until the run that never ends makes steps.
void wait_for_endless(Command& command, const Scratch& folder) {
  wait_for(command, folder / "out", "running", 1);
  wait_for(command, folder / "out", "converged", 1);
  command.wait_until("the endless run makes steps",
                     [&] { return fs::exists(folder / "out/runs/endless/seed_1/iterations.csv"); });
}

/// Two runs that converge at once and, between them, one that never does.
const std::string with_endless =
    "ablation:\n  - {name: first}\n"
    "  - {name: endless, set: {newton: {step_size: 1e-7, step_growth: 1, max_steps: 100000000}}}\n"
    "  - {name: last, set: {refiner: midpoint}}\n";

/// What every run has by this key, in their order: "converged cancelled pending".
std::string values_of(const nlohmann::json& runs, const std::string& key) {
  std::string all;
  for (const nlohmann::json& run : runs)
    all += (all.empty() ? "" : " ") + (run[key].is_string() ? run[key].get<std::string>() : run[key].dump());
  return all;
}

}  // namespace

TEST_CASE("24 runs give the same results with one worker and with two, and are not run again") {
  const Scratch folder;
  const Ended one = drape_ends(small_sweep + "--out one --workers 1", folder);
  CHECK_THAT(one.err, Contains("[24/24] refiner=midpoint,levels=2,step_growth=3, seed 3: converged after "));
  if (drape::core_count() >= 2) {
    drape_ends(small_sweep + "--out two --workers 2", folder);
    const auto expected = outcome_of(folder / "one");
    CHECK(expected.size() == 24 * 2 + 12 * 2 + 12 * 4);  // energies by method; meshes by method and level
    CHECK((outcome_of(folder / "two") == expected));
    // The seeds and the variations differ, so that the comparison says something.
    std::map<std::string, int> different;
    for (const auto& [name, content] : expected)
      if (name.find("newton_l0.ply") != std::string::npos) ++different[content];
    CHECK(different.size() >= 3);
  }

  const std::string before = text_of(folder / "one/sweep.json");
  CHECK(shown_by(small_sweep + "--out one", folder.path) == one.out);
  CHECK(text_of(folder / "one/sweep.json") == before);
  const nlohmann::json runs = runs_of(folder / "one");
  REQUIRE(values_of(runs, "starts") == "1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1");
  CHECK(runs[23]["name"] == "refiner=midpoint,levels=2,step_growth=3");
  CHECK(runs[23]["seed"] == 3);
  CHECK(runs[23]["settings"]["refiner"] == "midpoint");

  // Its table is tidy: a column a variable, a row an observation.
  const auto table = [&](const std::string& options) {
    return drape_with("table one" + options, folder.path).out;
  };
  const nlohmann::json rows = nlohmann::json::parse(table(" --format json"));
  REQUIRE(rows.size() == 48);
  const nlohmann::json& last = rows[47];
  CHECK(
      (last["run"] == runs[23]["name"] && last["refiner"] == "midpoint" && last["newton.step_growth"] == 3));
  CHECK((last["levels"].dump() == "2" && last["seed"].dump() == "3"));  // whole numbers
  const std::string columns =
      "sweep,run,refiner,levels,newton.step_growth,seed,method,pass,status,stability,";
  CHECK_THAT(table(" --format csv"), Catch::StartsWith(columns));
  const std::string page = table("");
  CHECK_THAT(page.substr(0, page.find('\n')), !Contains("error_rms"));  // of CSV and JSON, or if asked for

  // A run can be repeated by hand from the file beside it.
  const std::string run = "one/" + runs[23]["folder"].get<std::string>();
  drape_ends("run " + run + ".yaml --out by_hand --method all --quiet --no-report --measure", folder);
  CHECK(text_of(folder / "by_hand/levels/pcs_l1.ply") == text_of(folder / (run + "/levels/pcs_l1.ply")));
}

TEST_CASE("sweep.json has the status of every run from the beginning of a sweep") {
  const Scratch folder;
  drape_ends(small_sweep + "--out out", folder);
  std::atomic<bool> ended = false;
  std::atomic<int> read = 0, without = 0;
  std::thread reader([&] {
    while (!ended) {
      std::stringstream text;
      text << std::ifstream(folder / "out/sweep.json").rdbuf();
      const nlohmann::json runs =
          nlohmann::json::parse(text.str(), nullptr, false).value("runs", nlohmann::json::array());
      read += runs.size() == 24;
      without += std::any_of(runs.begin(), runs.end(),
                             [](const nlohmann::json& run) { return !run.contains("status"); });
    }
  });
  for (int k = 0; k < 10; ++k) drape_with(small_sweep + "--out out", folder.path);  // nothing is left to run
  ended = true;
  reader.join();
  CHECK(read > 10);
  CHECK(without == 0);
}

TEST_CASE("kill -9 loses only the active runs") {
  const Scratch folder;
  drape_ends(small_sweep + "--out whole", folder);
  for (const int done : {1, 9, 17}) {
    DrapeAtWork command(small_sweep + " --out cut", folder);
    wait_for(command, folder / "cut", "converged", done);
    command.send(SIGKILL);  // the sweep alone: its runs are in groups of their own, and must die with it
    REQUIRE(command.wait().exit_code == 128 + SIGKILL);
  }
  const nlohmann::json before = runs_of(folder / "cut");
  drape_ends(small_sweep + "--out cut", folder);
  CHECK((outcome_of(folder / "cut") == outcome_of(folder / "whole")));
  const nlohmann::json after = runs_of(folder / "cut");
  int starts = 0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    starts += after[k]["starts"].get<int>();
    if (before[k]["status"] == "converged") CHECK(after[k]["starts"] == before[k]["starts"]);
  }
  CHECK((24 <= starts && starts <= 24 + 3 * drape::core_count()));
}

TEST_CASE("Ctrl-C stops the runs, which save their state, and the same command resumes") {
  const SmallSweep folder(with_endless);
  DrapeAtWork command("sweep s.yaml --out out --workers 1", folder);
  wait_for_endless(command, folder);
  CHECK_THAT(refused_by("sweep s.yaml --out out", folder.path),
             Catch::Matches("error: out: another `drape sweep` uses this folder \\(process "
                            "[0-9]+ on .+\\); wait for it, or name another folder with "
                            "--out\n"));
  command.send(SIGINT);
  const Ended ended = command.wait();
  CHECK(ended.exit_code == 130);
  CHECK_THAT(ended.err, Contains("stopping: 1 run is saving its state\n"));
  CHECK_THAT(ended.err, Catch::EndsWith("stopped on request; the same command runs what is missing\n"));
  CHECK(values_of(folder.runs(), "status") == "converged cancelled pending");
  CHECK(values_of(folder.runs(), "starts") == "1 1 0");
  const nlohmann::json results = json_in(folder / "out/runs/endless/seed_1/results.json");
  CHECK(results["methods"]["newton"]["status"] == "cancelled");

  // With fewer steps it ends, though not converged: those are results, and the exit code says so.
  folder.write("s.yaml", replaced(text_of(folder / "s.yaml"), "max_steps: 100000000", "max_steps: 3"));
  folder.sweep(1);
  CHECK(values_of(folder.runs(), "status") == "converged not_converged converged");
  CHECK(values_of(folder.runs(), "starts") == "1 2 1");
  CHECK(folder.runs()[1]["exit_code"] == 1);
  CHECK(json_in(folder / "out/sweep.json")["complete"] == true);
}

TEST_CASE("a failed run is listed with its error, does not stop the others, and is retried only on request") {
  const SmallSweep folder(
      "ablation:\n  - {name: unheld, set: {pins: [{region: ball, point: [5, 5, 5]}]}}\n  - {name: fine}\n");
  const std::string error = "pin 0 (ball) selects no vertex of the coarsest level; widen its region";
  const Ended ended = folder.sweep(1);
  CHECK_THAT(ended.out, Contains(error) && Contains("unheld") && Contains("failed"));
  CHECK_THAT(ended.err, Contains("; 1 failed") && Contains(error));
  const nlohmann::json runs = folder.runs();
  CHECK(values_of(runs, "status") == "failed converged");
  CHECK(runs[0]["exit_code"] == 2);
  CHECK_THAT(runs[0]["error"].get<std::string>(), Contains(error));

  CHECK_THAT(folder.sweep(1).out, Contains(error));
  CHECK(values_of(folder.runs(), "starts") == "1 1");
  folder.sweep(1, " --retry-failed");
  CHECK(values_of(folder.runs(), "starts") == "2 1");
  // Once its experiment is another, it is no longer the one that failed.
  folder.write("s.yaml",
               replaced(text_of(folder / "s.yaml"), "point: [5, 5, 5]", "point: [0, 0, 0], radius: 0.3"));
  folder.sweep();
  CHECK(folder.runs()[0]["starts"] == 3);
}

TEST_CASE("a killed run has failed, with the name of the signal") {
  const SmallSweep folder(with_endless);
  DrapeAtWork command("sweep s.yaml --out out --workers 1", folder);
  wait_for_endless(command, folder);
  // The one process whose command names this run's folder.
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::stringstream words;
    words << std::ifstream(entry.path() / "cmdline", std::ios::binary).rdbuf();
    const std::string name = entry.path().filename();
    std::error_code none;
    if (words.str().find("out/runs/endless/seed_1.yaml") != std::string::npos &&
        fs::read_symlink(entry.path() / "cwd", none) == fs::canonical(folder.path))
      kill(std::stoi(name), SIGKILL);
  }
  CHECK(command.wait().exit_code == 1);
  CHECK(values_of(folder.runs(), "status") == "converged failed converged");
  CHECK(folder.runs()[1]["error"] == "ended by signal 9 (Killed)");
}

TEST_CASE("a sweep that no longer fits its results is refused, and the results stay") {
  const SmallSweep folder("ablation: [{name: a}, {name: b, set: {refiner: midpoint}}]\n");
  const std::string sweep = text_of(folder / "s.yaml");
  folder.sweep();
  const std::string before = text_of(folder / "out/sweep.json");
  const std::string ways =
      "; give the new sweep another folder with --out, or undo the change, or delete that run's files to run "
      "it again: ";
  const auto said = [&](const std::string& arguments) {
    const std::string ended = refused_by("sweep s.yaml --out out" + arguments, folder.path);
    CHECK(text_of(folder / "out/sweep.json") == before);
    return ended;
  };
  folder.write("s.yaml", replaced(sweep, "midpoint", "loop, levels: 2"));
  CHECK(said("") ==
        "error: out: the results of run \"b\", seed 1 are of another experiment than the sweep now says" +
            ways + "out/runs/b/seed_1*\n");
  folder.write("s.yaml", replaced(sweep, "{name: a}, ", ""));
  CHECK(said("") == "error: out: has results of run \"a\", seed 1, which the sweep no longer has" + ways +
                        "out/runs/a/seed_1*\n");
  folder.write("s.yaml", sweep);
  if (drape::core_count() >= 2)
    CHECK(said(" --threads 2") ==
          "error: out: run \"a\", seed 1 was made with 1 thread per run, not 2, so times would not compare" +
              ways + "out/runs/a/seed_1*\n");
  // What was added is run; what was there is not.
  folder.write("s.yaml", replaced(sweep, "{name: a}, ", "{name: a}, {name: c, levels: 2}, "));
  folder.sweep();
  CHECK(values_of(folder.runs(), "starts") == "1 1 1");
  // A foreign folder in the place of a run's stays.
  fs::create_directories(folder / "out/runs/d/seed_1");
  folder.write("s.yaml",
               replaced(sweep, "{name: a}, ", "{name: a}, {name: c, levels: 2}, {name: d, levels: 3}, "));
  CHECK(refused_by("sweep s.yaml --out out", folder.path) ==
        "error: out/runs/d/seed_1: is there already, and not from this sweep; move it away, or name another "
        "folder with --out\n");
  CHECK(fs::exists(folder / "out/runs/d/seed_1"));
}

TEST_CASE("runs that exceed the memory together run one after another, with a warning") {
  if (drape::core_count() < 2) return;
  const SmallSweep folder("repeats: 4\n");
  const Ended ended = folder.sweep(0, " --workers 2 --memory-limit 0.001");
  CHECK_THAT(ended.err, Contains("warning: base, seed 1 may need 0.1 GB where 0.0 GB are to be had; it runs "
                                 "alone\n"));
  double last_end = 0;
  for (const nlohmann::json& run : folder.runs()) {
    const fs::path log = folder / ("out/" + run["folder"].get<std::string>() + "/log.jsonl");
    std::istringstream lines(text_of(log));
    std::string first, last;
    for (std::string line; std::getline(lines, line); last = line)
      if (first.empty()) first = line;
    CHECK(nlohmann::json::parse(first)["time"].get<double>() > last_end);
    last_end = nlohmann::json::parse(last)["time"];
  }
}

TEST_CASE("two tasks for one run, as after a daemon's death, run it once") {
  const SmallSweep folder;
  folder.sweep();
  fs::remove_all(folder / "out/runs/base/seed_1");
  fs::remove(folder / "out/runs/base/seed_1.status.json");
  DrapeAtWork first("sweep-job out --task 0", folder), second("sweep-job out --task 0", folder);
  CHECK(first.wait().exit_code == 0);
  CHECK(second.wait().exit_code == 0);
  drape_ends("sweep-job out", folder);  // collects
  CHECK(values_of(folder.runs(), "status") == "converged");
  CHECK(values_of(folder.runs(), "starts") == "1");
  CHECK(refused_by("sweep-job out --task 1", folder.path) == "error: out: sweep.json has no run 1\n");
}
