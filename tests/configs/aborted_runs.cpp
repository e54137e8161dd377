// Runs in which something fails: what a method throws is its outcome, what keeps a run from going on ends it
// with an exit code of its own.

#include "core/app/experiment/exit_codes.h"
#include "tests/configs/runs.h"

namespace {

/// The small experiment with one more method before its own, and one more energy, of a plugin that fails.
struct FailingExperiment : Scratch {
  explicit FailingExperiment(const std::string& method, const std::string& energy = "") {
    std::string text = small_experiment();
    if (!method.empty())
      text = replaced(text, "methods:\n", "methods:\n  odd: {type: failing, " + method + "}\n");
    if (!energy.empty())
      text = replaced(text, "[neo_hookean,", "[{type: failing, " + energy + "}, neo_hookean,");
    write("e.yaml", text);
  }
  Ended with(const std::string& arguments, int exit_code = drape::exit_not_converged) const {
    const Ended ended =
        drape_with(arguments, path, "DRAPE_PLUGIN_PATH=" + folders::test_plugins().string() + "/failing");
    INFO(ended.err);
    REQUIRE(ended.exit_code == exit_code);
    return ended;
  }
  /// The methods' results of a run in which some fail.
  nlohmann::json methods(const std::string& options) const {
    with("run e.yaml --out out --overwrite --no-report --measure " + options);
    const nlohmann::json all = results_in(path / "out");
    CHECK(all["complete"] == true);
    return all["methods"];
  }
  /// The message of the additional method at a level of a run by it alone.
  std::string message(int level, const std::string& options = "") const {
    return methods("--method odd " + options)["odd"]["levels"][level]["message"];
  }
};

/// The events of that name in log.jsonl.
nlohmann::json events(const Scratch& folder, const std::string& name) {
  auto found = nlohmann::json::array();
  std::istringstream lines(text_of(folder / "out/log.jsonl"));
  for (std::string line; std::getline(lines, line);)
    if (const auto event = nlohmann::json::parse(line); event["event"] == name) found.push_back(event);
  return found;
}

}  // namespace

TEST_CASE("A method that throws has failed, with level and cause, and the others run") {
  const std::pair<std::string, std::string> causes[] = {
      {"error", "the test's method fails"},
      {"memory", "memory does not suffice; take fewer vertices or levels, or a smaller file"},
      {"other", "an exception that is no std::exception"}};
  for (const auto& [throws, cause] : causes) {
    INFO(throws);
    const FailingExperiment folder("level: 1, throws: " + throws);
    CHECK_THAT(folder.with("run e.yaml --out out --method all --no-report --measure").err,
               Contains("odd       level 1/1 failed       " + cause + "\n"));
    const nlohmann::json all = results_in(folder / "out");
    CHECK(all["complete"] == true);
    REQUIRE(outcome_of_method(all["methods"]["odd"]) == "failed: converged failed");
    CHECK(all["methods"]["odd"]["levels"][1]["message"] == cause);
    for (const char* other : {"pcs", "cascadic", "newton"})
      CHECK(all["methods"][other]["status"] == "converged");
    const nlohmann::json failed = events(folder, "method_failed");
    REQUIRE(failed.size() == 1);
    CHECK(failed[0]["level"] == 1);
    CHECK(failed[0]["message"] == cause);
    CHECK_THAT(folder.with("table out --columns method,status,message").out,
               Contains("converged, failed") && Contains("level 1: " + cause));
    folder.with("run --resume out");  // has the run's own exit code
  }
}

TEST_CASE("A method's result does not rest on its word") {
  const std::pair<std::string, std::string> causes[] = {
      {"no_level", "the method solved no level"},
      {"level_nine", "the method reported level 9; the experiment's finest is level 1"},
      {"level_zero",
       "the method reported level 0 after level 0; report levels from coarse to fine, each once"},
      {"no_vertices", "the method reported a state of level 1 with 0 vertices; the level has 121"},
      {"not_a_number", "the method reported a state of level 1 that is not finite"},
      {"to_nobody", "the method returned the results of 2 levels and reported 1 to its observer"}};
  for (const auto& [reports, cause] : causes) {
    INFO(reports);
    const auto odd = FailingExperiment("level: 1, reports: " + reports).methods("--method odd")["odd"];
    CHECK(odd["status"] == "failed");
    CHECK(odd["levels"].back()["message"] == cause);
  }
  const std::string says = "the method says that it converged; ", lowest = "--set reference=lowest";
  const FailingExperiment quick("level: 9"), moved("level: 0, reports: moved_pins");
  const nlohmann::json levels = quick.methods("--method odd " + lowest)["odd"]["levels"];
  CHECK(levels[0]["status"] == "converged");  // by its own objective, which the run does not know
  CHECK(levels[1]["status"] == "stalled");
  CHECK_THAT(levels[1]["message"].get<std::string>(), StartsWith(says + "the force residual is "));
  CHECK_FALSE(results_in(quick / "out").contains("reference"));
  // Neither a residual that it admits nor one that it excuses by round-off makes a start an end.
  for (const char* reports : {"residual", "rounding"}) {
    INFO(reports);
    const FailingExperiment admits(std::string("level: 1, reports: ") + reports);
    CHECK_THAT(admits.message(1), StartsWith(says + "the force residual is "));
  }
  // A method has its own tolerance.
  FailingExperiment("level: 9, newton: {force_tolerance: 1e6}")
      .with("run e.yaml --out out --no-report --method odd", drape::exit_done);
  CHECK(moved.message(0, lowest) == says + "a pin is 0.173 m off its target");
  CHECK(quick.message(
            0,
            "--set 'schedule={steps: 2, keys: [{parameter: energies.gravity.acceleration, times: [0, 1], "
            "values: [[0, 0, -9.81], [0, 0, -5]]}]}'") == says + "the schedule has not come to its end");
}

TEST_CASE("Cloth that jaws hold by friction has converged, but not where a method only says so") {
  const FailingExperiment folder("");
  folder.write("e.yaml", R"(name: gripped
cloth: {shape: rectangle, size: [0.25, 0.3], vertices: 400}
levels: 1
material: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e5, bending_modulus: 8e5, poisson_ratio: 0.243}
start: {rotate: [90, 0, 0]}
energies: [neo_hookean, hinge, gravity]
contact: [ipc]
obstacles:
  - {name: left, meshed_shape: box, size: [0.2, 0.1, 0.1], translate: [0.125, -0.0503, 0.2]}
  - {name: right, meshed_shape: box, size: [0.2, 0.1, 0.1], translate: [0.125, 0.0503, 0.2]}
friction: 0.6
methods: {odd: {type: failing, level: 9}, pcs: {}}
)");
  const auto methods = folder.methods("--method all");
  CHECK(methods["pcs"]["status"] == "converged");
  CHECK(methods["odd"]["status"] == "stalled");
}

TEST_CASE("An energy that throws fails every method that evaluates it, where it does") {
  // The finest level's energies are made once: the first method to evaluate them is the one that fails.
  const auto solving = FailingExperiment("", "level: 1, gradients: 5").methods("--method all");
  REQUIRE(outcome_of_method(solving["pcs"]) == "failed: failed");
  CHECK(solving["pcs"]["levels"][0]["level"] == 0);
  CHECK(solving["pcs"]["levels"][0]["message"] == "the test's gradient fails");
  for (const char* other : {"cascadic", "newton"}) CHECK(solving[other]["status"] == "converged");

  const auto recording = FailingExperiment("level: 9", "level: 0, values: 0").methods("--method odd,newton");
  REQUIRE(outcome_of_method(recording["odd"]) == "failed: failed");
  CHECK(recording["odd"]["levels"][0]["message"] == "the test's value fails");
  CHECK(recording["newton"]["status"] == "converged");
}

TEST_CASE("A folder that is deleted during a run aborts it with its own code, and stays deleted") {
  for (const std::string gone : {"out", "out/levels"}) {
    INFO(gone);
    const FailingExperiment folder("level: 1, command: rm -r " + gone);
    const std::string said =
        folder.with("run e.yaml --out out --method all -q --no-report --measure", drape::exit_aborted).err;
    check_error(said, "cannot write out/levels/odd_l1.ply: No such file or directory");
    CHECK_THAT(said, Contains("; the run is aborted. "));
    CHECK(fs::exists(folder / "out") == (gone != "out"));
    if (gone == "out") continue;
    const nlohmann::json all = results_in(folder / "out");
    CHECK(all["complete"] == false);
    CHECK(all["methods"]["odd"]["status"] == "aborted");
    CHECK(events(folder, "run_aborted").size() == 1);
    CHECK_THAT(folder.with("table out --columns status").out, Contains("| converged, aborted |"));
    CHECK_THAT(all["aborted"].get<std::string>(), StartsWith("cannot write out/levels/odd_l1.ply"));
    folder.with("report out --width 90", 0);
    folder.with("run --resume out --quiet --no-report --measure", drape::exit_aborted);  // fails at the same
  }
}

TEST_CASE("A run that has lost a file it cannot be resumed without is to be run again") {
  const FailingExperiment folder("level: 1, command: rm out/iterations.csv");
  CHECK(folder
            .with("run e.yaml --out out --method newton,odd,pcs --checkpoint 0 --quiet --no-report --measure",
                  drape::exit_aborted)
            .err ==
        "error: cannot write out/iterations.csv: No such file or directory; the run is aborted. Once the "
        "cause is removed, run the experiment again with --overwrite: its iterations.csv is missing\n");
  CHECK(fs::exists(folder / "out/checkpoint/state.bin"));
}

TEST_CASE("A full disk aborts the run with its own code; once there is room it can be resumed") {
  const Scratch folder(small_experiment());
  const std::string arguments =
      " run e.yaml --method all --quiet --no-report --measure --threads 1 --set cloth.columns=24 --set "
      "cloth.rows=24 "
      "--set newton.max_steps=3 --set snapshots=0 --out ";
  drape_ends(arguments + "whole", folder, drape::exit_not_converged);
  // A limit on every file's size stands for the disk. It falls between what is written at the beginning and
  // what has the whole state in it.
  const auto largest = fs::file_size(folder / "whole/rest/l1.ply");
  REQUIRE(fs::file_size(folder / "whole/levels/pcs_l1.vtp") > largest + 4096);
  const auto aborted = [&](std::uintmax_t bytes, const std::string& line) {
    const Ended ended =
        Command("ulimit -f " + std::to_string(bytes / 512) + " && exec " + drape_command + line, folder.path)
            .wait();
    CHECK(ended.exit_code == drape::exit_aborted);
    return ended.err;
  };
  CHECK_THAT(aborted(largest + 2048, arguments + "out"),
             StartsWith("error: cannot write out/") && Contains("File too large") &&
                 Contains("resume it with drape run --resume out"));
  const nlohmann::json all = results_in(folder / "out");
  CHECK(all["complete"] == false);
  CHECK(all["methods"]["pcs"]["status"] == "aborted");
  CHECK(all["methods"].size() == 1);  // the others could not be written either
  for (const auto& [name, bytes] : files_in(folder / "out")) CHECK_FALSE(name.ends_with(".part"));

  const std::string resume = "run --resume out --quiet --no-report --measure --threads 1";
  CHECK_THAT(drape_ends(resume, folder, drape::exit_not_converged).err, Catch::Matches(shortfalls));
  CHECK_FALSE(results_in(folder / "out").contains("aborted"));
  check_same_files(folder / "out", folder / "whole", {"levels/pcs_l1.ply", "levels/newton_l1.ply"});

  // Before the first method, and where the rows of iterations.csv no longer fit.
  aborted(largest / 2, arguments + "early");
  CHECK_THAT(aborted(16 * 512,
                     " run e.yaml --quiet --no-report --measure --method newton --levels 1 --set snapshots=0 "
                     "--set newton.step_size=1e-4 --set newton.step_growth=1 --checkpoint 1e6 --out rows"),
             StartsWith("error: cannot write rows/iterations.csv: "));
}

TEST_CASE("A complete run that cannot store what it measures is not said to be aborted") {
  const Scratch folder(small_experiment());
  drape_ends("run e.yaml --method pcs --quiet --no-report --out out", folder);
  const Ended full =
      Command("ulimit -f 4 && exec " + drape_command + " table out --columns preview_rms", folder.path)
          .wait();
  CAPTURE(full.err);
  CHECK_THAT(full.err, Contains("File too large") && Contains("the next report measures") &&
                           !Contains("aborted") && !Contains("--resume"));
  CHECK_FALSE(results_in(folder / "out").contains("aborted"));
}

TEST_CASE("Standard output that is lost is an error, but for a run or a sweep, whose results are elsewhere") {
  if (!fs::exists("/dev/full")) return;
  const Scratch folder(small_experiment());
  folder.write("s.yaml", "name: s\nbase: e.yaml\nset: {levels: 1}\nmethods: [newton]\n");
  const auto check_into_full = [&](const std::string& line, int exit_code, const std::string& said) {
    INFO(line);
    const Ended ended = Command("exec " + drape_command + " " + line + " > /dev/full", folder.path).wait();
    CHECK(ended.exit_code == exit_code);
    CHECK(ended.err == said);
  };
  for (const char* line : {"run e.yaml --levels 1 --quiet --no-report --measure --out out",
                           "run --resume out", "sweep s.yaml --quiet --out swept"})
    check_into_full(line, drape::exit_done,
                    "warning: standard output cannot be written to; the results are not affected\n");
  CHECK(results_in(folder / "out")["complete"] == true);
  for (const char* line : {"sweep s.yaml --dry-run --out swept", "table out", "list"})
    check_into_full(line, drape::exit_aborted, "error: standard output cannot be written to\n");
}
