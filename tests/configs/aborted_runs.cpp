// Runs in which something fails: what a method throws is its outcome, what keeps a run from going on ends it
// with an exit code of its own, and what is refused leaves no trace.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/experiment/exit_codes.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"
#include "tests/support/page_data.h"

namespace fs = std::filesystem;
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string with_failing = "DRAPE_PLUGIN_PATH=" + (folders::test_plugins() / "failing").string();

nlohmann::json results_in(const Scratch& folder) { return json_in(folder / "out/results.json"); }

/// The small experiment with one more method before its own, and energies of its own.
void write_experiment(const Scratch& folder, const std::string& method, const std::string& energy = "") {
  std::string text = small_experiment();
  if (!method.empty()) text = replaced(text, "methods:\n", "methods:\n  odd: " + method + "\n");
  if (!energy.empty()) text = replaced(text, "[neo_hookean,", "[" + energy + ", neo_hookean,");
  folder.write("e.yaml", text);
}

/// Runs the experiment, by all of its methods or those that the options name; some must fail. Its results.
nlohmann::json failed_run(const Scratch& folder, const std::string& options = "--method all") {
  const Ended ended = drape_with("run e.yaml --out out --no-report " + options, folder.path, with_failing);
  INFO(ended.err);
  REQUIRE(ended.exit_code == drape::exit_not_converged);
  return results_in(folder);
}

/// The events of that name in log.jsonl.
std::vector<nlohmann::json> events(const Scratch& folder, const std::string& name) {
  std::vector<nlohmann::json> found;
  std::istringstream lines(text_of(folder / "out/log.jsonl"));
  for (std::string line; std::getline(lines, line);)
    if (nlohmann::json event = nlohmann::json::parse(line); event["event"] == name) found.push_back(event);
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
    const Scratch folder;
    write_experiment(folder, "{type: failing, level: 1, throws: " + throws + "}");
    const Ended ended =
        drape_with("run e.yaml --out out --method all --no-report", folder.path, with_failing);
    CHECK(ended.exit_code == drape::exit_not_converged);
    CHECK_THAT(ended.err, Contains("odd       level 1/1 failed       " + cause + "\n"));

    const nlohmann::json all = results_in(folder);
    CHECK(all["complete"] == true);
    const nlohmann::json& odd = all["methods"]["odd"];
    CHECK(odd["status"] == "failed");
    REQUIRE(odd["levels"].size() == 2);
    CHECK(odd["levels"][0]["status"] == "converged");
    CHECK(odd["levels"][1]["status"] == "failed");
    CHECK(odd["levels"][1]["message"] == cause);
    for (const char* other : {"pcs", "cascadic", "newton"})
      CHECK(all["methods"][other]["status"] == "converged");
    REQUIRE(events(folder, "method_failed").size() == 1);
    CHECK(events(folder, "method_failed")[0]["level"] == 1);
    CHECK(events(folder, "method_failed")[0]["message"] == cause);

    drape_ends("report out --width 90", folder);
    const nlohmann::json page = page_data(text_of(folder / "out/report.html"));
    CHECK(page["results"]["methods"]["odd"]["levels"][1]["status"] == "failed");
    CHECK_THAT(drape_ends("table out --columns method,status,message", folder, drape::exit_not_converged).out,
               Contains("converged, failed") && Contains("level 1: " + cause));
    CHECK(drape_with("run --resume out", folder.path, with_failing).exit_code == drape::exit_not_converged);
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
    const Scratch folder;
    write_experiment(folder, "{type: failing, level: 1, reports: " + reports + "}");
    const nlohmann::json odd = failed_run(folder, "--method odd")["methods"]["odd"];
    CHECK(odd["status"] == "failed");
    CHECK(odd["levels"].back()["message"] == cause);
  }
  const Scratch folder;
  const std::string lowest = "--method odd --set reference=lowest --overwrite";
  write_experiment(folder, "{type: failing, level: 9}");
  const nlohmann::json all = failed_run(folder, lowest), levels = all["methods"]["odd"]["levels"];
  CHECK(levels[0]["status"] == "converged");  // by its own objective, which the run does not know
  CHECK(levels[1]["status"] == "stalled");
  CHECK_THAT(levels[1]["message"].get<std::string>(),
             StartsWith("the method says that it converged; the force residual is "));
  CHECK_FALSE(all.contains("reference"));
  write_experiment(folder, "{type: failing, level: 0, reports: moved_pins}");
  CHECK(failed_run(folder, lowest)["methods"]["odd"]["levels"][0]["message"] ==
        "the method says that it converged; a pin is 0.173 m off its target");
  write_experiment(folder, "{type: failing, level: 9}");
  folder.write("e.yaml", text_of(folder / "e.yaml") +
                             "schedule: {steps: 2, keys: [{parameter: energies.gravity.acceleration, "
                             "times: [0, 1], values: [[0, 0, -9.81], [0, 0, -5]]}]}\n");
  CHECK(failed_run(folder, "--method odd --overwrite")["methods"]["odd"]["levels"][0]["message"] ==
        "the method says that it converged; the schedule has not come to its end");
}

TEST_CASE("An energy that throws fails every method that evaluates it, where it does") {
  const Scratch folder;
  SECTION("while a level is solved") {
    write_experiment(folder, "", "{type: failing, level: 1, gradients: 5}");
    const nlohmann::json all = failed_run(folder);
    CHECK(all["complete"] == true);
    // The finest level's energies are made once: the first method to evaluate them is the one that fails.
    const nlohmann::json& pcs = all["methods"]["pcs"];
    CHECK(pcs["status"] == "failed");
    REQUIRE(pcs["levels"].size() == 1);
    CHECK(pcs["levels"][0]["level"] == 0);
    CHECK(pcs["levels"][0]["message"] == "the test's gradient fails");
    CHECK(all["methods"]["cascadic"]["status"] == "converged");
    CHECK(all["methods"]["newton"]["status"] == "converged");
  }
  SECTION("while a level's result is recorded") {
    write_experiment(folder, "{type: failing, level: 9}", "{type: failing, level: 0, values: 0}");
    const nlohmann::json methods = failed_run(folder, "--method odd,newton")["methods"];
    CHECK(methods["odd"]["status"] == "failed");
    REQUIRE(methods["odd"]["levels"].size() == 1);
    CHECK(methods["odd"]["levels"][0]["message"] == "the test's value fails");
    CHECK(methods["newton"]["status"] == "converged");
  }
}

TEST_CASE("A folder that is deleted during a run aborts it with its own code, and stays deleted") {
  for (const char* gone : {"out", "out/levels"}) {
    INFO(gone);
    const Scratch folder;
    write_experiment(folder, "{type: failing, level: 1, command: rm -r " + std::string(gone) + "}");
    const Ended ended =
        drape_with("run e.yaml --out out --method all --quiet --no-report", folder.path, with_failing);
    CHECK(ended.exit_code == drape::exit_aborted);
    CHECK_THAT(ended.err, StartsWith("error: cannot write out/levels/odd_l1.ply: No such file or directory"));
    CHECK_THAT(ended.err, Contains("; the run is aborted. "));
    CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
    if (gone == std::string("out")) {
      CHECK_FALSE(fs::exists(folder / "out"));
      continue;
    }
    const nlohmann::json all = results_in(folder);
    CHECK(all["complete"] == false);
    CHECK_THAT(all["aborted"].get<std::string>(), StartsWith("cannot write out/levels/odd_l1.ply"));
    CHECK(all["methods"]["odd"]["status"] == "aborted");
    CHECK(events(folder, "run_aborted").size() == 1);
    CHECK_THAT(drape_ends("table out --columns method,status", folder, drape::exit_not_converged).out,
               Contains("| odd | converged, aborted |"));
    drape_ends("report out --width 90", folder);
    CHECK_THAT(page_data(text_of(folder / "out/report.html"))["results"]["aborted"].get<std::string>(),
               StartsWith("cannot write "));
    // which fails at the same
    CHECK(drape_with("run --resume out --quiet --no-report", folder.path, with_failing).exit_code ==
          drape::exit_aborted);
  }
}

TEST_CASE("A run that has lost a file it cannot be resumed without is to be run again") {
  const Scratch folder;
  write_experiment(folder, "{type: failing, level: 1, command: rm out/iterations.csv}");
  const Ended ended =
      drape_with("run e.yaml --out out --method newton,odd,pcs --checkpoint 0 --quiet --no-report",
                 folder.path, with_failing);
  CHECK(ended.exit_code == drape::exit_aborted);
  CHECK(ended.err ==
        "error: cannot write out/iterations.csv: No such file or directory; the run is aborted. Once the "
        "cause is removed, run the experiment again: its iterations.csv is missing\n");
  CHECK(fs::exists(folder / "out/checkpoint/state.bin"));
}

TEST_CASE("A full disk aborts the run with its own code; once there is room it can be resumed") {
  const Scratch folder(small_experiment());
  const std::string arguments =
      " run e.yaml --method all --quiet --no-report --threads 1 --set cloth.columns=24 --set cloth.rows=24 "
      "--set newton.max_steps=3 --set snapshots=0 --out ";
  drape_ends(arguments + "whole", folder, drape::exit_not_converged);
  // A limit on every file's size stands for the disk. It falls between what is written at the beginning and
  // what has the whole state in it.
  const auto largest = fs::file_size(folder / "whole/rest/l1.ply");
  REQUIRE(fs::file_size(folder / "whole/levels/pcs_l1.vtp") > largest + 4096);
  const auto limited = [&](std::uintmax_t bytes, const std::string& line) {
    return Command("ulimit -f " + std::to_string(bytes / 512) + " && exec " + drape_command + line,
                   folder.path)
        .wait();
  };
  const Ended ended = limited(largest + 2048, arguments + "out");
  CHECK(ended.exit_code == drape::exit_aborted);
  CHECK_THAT(ended.err, StartsWith("error: cannot write out/") && Contains("File too large") &&
                            Contains("resume it with drape run --resume out"));
  const nlohmann::json all = results_in(folder);
  CHECK(all["complete"] == false);
  CHECK_THAT(all["aborted"].get<std::string>(), Contains("File too large"));
  CHECK(all["methods"]["pcs"]["status"] == "aborted");
  CHECK(all["methods"].size() == 1);  // the others could not be written either
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out"))
    CHECK(entry.path().extension() != ".part");

  CHECK(
      drape_ends("run --resume out --quiet --no-report --threads 1", folder, drape::exit_not_converged).err ==
      "");
  CHECK_FALSE(results_in(folder).contains("aborted"));
  for (const char* mesh : {"levels/pcs_l1.ply", "levels/newton_l1.ply"})
    CHECK((text_of(folder / "out" / mesh) == text_of(folder / "whole" / mesh)));

  // Before the first method, and where the rows of iterations.csv no longer fit.
  CHECK(limited(largest / 2, arguments + "early").exit_code == drape::exit_aborted);
  const Ended rows =
      limited(16 * 512,
              " run e.yaml --quiet --no-report --method newton --levels 1 --set snapshots=0 "
              "--set newton.step_size=1e-4 --set newton.step_growth=1 --checkpoint 1e6 --out rows");
  CHECK(rows.exit_code == drape::exit_aborted);
  CHECK_THAT(rows.err, StartsWith("error: cannot write rows/iterations.csv: "));
}

TEST_CASE("Standard output that is lost is an error, but for a run or a sweep, whose results are elsewhere") {
  if (!fs::exists("/dev/full")) return;
  const Scratch folder(small_experiment());
  folder.write("s.yaml", "name: s\nbase: e.yaml\nset: {levels: 1}\nmethods: [newton]\n");
  const auto into_full = [&](const std::string& line) {
    return Command("exec " + drape_command + " " + line + " > /dev/full", folder.path).wait();
  };
  const std::string warning = "warning: standard output cannot be written to; the results are not affected\n";
  for (const char* line : {"run e.yaml --levels 1 --quiet --no-report --out out", "run --resume out",
                           "sweep s.yaml --quiet --out swept"}) {
    INFO(line);
    const Ended ended = into_full(line);
    CHECK(ended.exit_code == drape::exit_done);
    CHECK(ended.err == warning);
  }
  CHECK(results_in(folder)["complete"] == true);
  for (const char* line : {"sweep s.yaml --dry-run --out swept", "table out", "list"}) {
    INFO(line);
    const Ended ended = into_full(line);
    CHECK(ended.exit_code == drape::exit_aborted);
    CHECK(ended.err == "error: standard output cannot be written to\n");
  }
}

TEST_CASE("Names that the file system does not allow are refused before the first write") {
  const Scratch folder;
  const std::string longest(200, 'm'), too_long(201, 'm');
  const auto refused = [&](const std::string& line, const std::string& expected) {
    CHECK_THAT(refused_by(line, folder.path), Contains(expected));
    CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
  };
  folder.write("e.yaml", replaced(small_experiment(), "  pcs: {}\n", "  " + too_long + ": {type: pcs}\n"));
  refused("check e.yaml", "names files: it has 201 bytes, and may have 200");
  refused("run e.yaml --out out", "names files: it has 201 bytes, and may have 200");
  folder.write("e.yaml", small_experiment());
  refused("run e.yaml --out a/b/" + std::string(300, 'x'), "has 300 bytes, and the file system takes 255");
  std::string deep = "d";
  for (int k = 0; k < 45; ++k) deep += "/" + std::string(90, 'd');
  refused("run e.yaml --out " + deep, "less deep with --out");
  folder.write("e.yaml", replaced(small_experiment(), "  pcs: {}\n", "  \"a\xff\": {type: pcs}\n"));
  refused("run e.yaml --out out", "error: ");
  folder.write("e.yaml", replaced(small_experiment(), "  pcs: {}\n", "  " + longest + ": {type: pcs}\n"));
  drape_ends("run e.yaml --method all --quiet --no-report --out out", folder);
}
