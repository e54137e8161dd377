// Files that a sweep left and that were changed since.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/sweep_runs.h"

using Catch::Contains;

TEST_CASE("a value of the wrong kind in a sweep's files is named with its file and its key") {
  const SmallSweep folder;
  folder.sweep();
  // What the sweep says of the file with this value there, or without one.
  const auto said = [&](const std::string& file, const std::string& path, const std::string& value) {
    const std::string sound = text_of(folder / file);
    nlohmann::json json = nlohmann::json::parse(sound);
    const nlohmann::json::json_pointer at(path);
    if (value.empty())
      json[at.parent_pointer()].erase(at.back());
    else
      json[at] = nlohmann::json::parse(value);
    folder.write(file, json.dump());
    const std::string ended = refused_by("sweep s.yaml --out out", folder.path);
    folder.write(file, sound);
    return replaced(ended, "error: " + file + ": ", "");
  };
  const std::string status = "out/runs/base/seed_1.status.json",
                    remove = "; remove it and the run's folder\n";
  CHECK(said(status, "/status", R"("done")") == R"(no status is called "done")" + remove);
  CHECK(said(status, "/threads", "1e300") == R"("threads" must be a whole number, not 1e+300)" + remove);
  CHECK(said(status, "/seconds", "") == R"("seconds" is missing)" + remove);
  CHECK_THAT(said(status, "", "7"), Catch::StartsWith("is not a run's status") && Catch::EndsWith(remove));

  const std::string sweep = "out/sweep.json", another = "; name another folder with --out\n";
  CHECK(said(sweep, "/sweep", "1") == R"("sweep" must be a text, not 1)" + another);
  CHECK(said(sweep, "/time_limit", R"("long")") == R"("time_limit" must be a number, not "long")" + another);
  CHECK(said(sweep, "/runs", R"("none")") == R"("runs" must be a list)" + another);
  CHECK(said(sweep, "/runs/0", "null") == R"("name" is missing)" + another);
  CHECK(said(sweep, "/runs/0/seed", "-1e300") == R"("seed" must be a whole number, not -1e+300)" + another);
  CHECK(said(sweep, "/runs/0/expect/message", "") == R"("runs[].expect.message" is missing)" + another);

  const std::string results = "out/runs/base/seed_1/results.json",
                    rerun = "; remove the run's folder, and the sweep runs it again\n";
  CHECK(said(results, "/methods/newton/peak_memory_bytes", R"("all")") ==
        R"("peak_memory_bytes" must be a number, not "all")" + rerun);
  folder.write(status, replaced(text_of(folder / status), R"("converged")", R"("running")"));
  CHECK(said(results, "/methods/newton/status", "[1]") == R"("status" must be a text, not [1])" + rerun);
  // Results that do not say whether they are complete count as none.
  folder.write(results, replaced(text_of(folder / results), R"("complete": true)", R"("complete": "yes")"));
  folder.sweep();
  CHECK(folder.runs()[0]["starts"] == 2);
}

TEST_CASE("a run whose results are cut short has failed, and the sweep's others are as they were") {
  const SmallSweep folder("seeds: [1, 2]\n");
  folder.sweep();
  const std::string run = "out/runs/base/seed_1", results = run + "/results.json";
  folder.write(results, "{");

  const std::string why = results + ": is damaged or cut short: it is not a JSON object; ";
  const Ended table = drape_ends("table out --columns seed,status,pass,message", folder, 1);
  CHECK_THAT(table.out, Contains("| 1 | failed | NO | " + why + "run the experiment again |") &&
                            Contains("| 2 | converged | yes |"));
  drape_ends("report out", folder);
  CHECK_THAT(folder.sweep(0, " --dry-run").out, Contains("failed     " + run.substr(4)));

  CHECK_THAT(folder.sweep(1).out, Contains("    " + why + "--retry-failed runs it again\n"));
  nlohmann::json runs = folder.runs();
  CHECK(runs[0]["status"] == "failed");
  CHECK(runs[0]["exit_code"] == 3);
  CHECK(runs[1]["status"] == "converged");
  folder.write(results, R"({"complete": true})");
  folder.sweep(1);
  folder.sweep(0, " --retry-failed");
  runs = folder.runs();
  CHECK(runs[0]["starts"] == 2);
  CHECK(runs[1]["starts"] == 1);
  folder.write(results, replaced(text_of(folder / results), R"("complete": true)", R"("complete": false)"));
  CHECK_THAT(folder.sweep(1).out, Contains("is of a run that is not complete"));
  CHECK(folder.runs()[0]["status"] == "failed");
}

TEST_CASE("a sweep whose sweep.json or a run's folder is gone keeps what is finished and runs what is not") {
  const SmallSweep folder;
  folder.sweep();
  const std::string log = "out/runs/base/seed_1/log.jsonl", before = text_of(folder / log);
  for (const bool is_empty : {false, true}) {
    if (is_empty)
      folder.write("out/sweep.json", "");
    else
      std::filesystem::remove(folder / "out/sweep.json");
    folder.sweep();
    CHECK(text_of(folder / log) == before);
    CHECK(folder.runs()[0]["status"] == "converged");
  }
  std::filesystem::remove_all(folder / "out/runs/base/seed_1");
  folder.sweep();
  CHECK(folder.runs()[0]["starts"] == 2);
  CHECK(std::filesystem::exists(folder / "out/runs/base/seed_1/results.json"));
}
