// What a run of one method leaves to measure until somebody asks.

#include "tests/configs/resuming.h"
#include "tests/support/registry.h"

TEST_CASE("a table measures what a run of one method has left: once, with the results of --measure") {
  const Scratch folder;
  write_sheets(folder);
  run_into("whole", folder, "--method pcs --threads 1");
  const Ended ended = drape_ends("run e.yaml --out out --method pcs --threads 1", folder);
  CHECK_THAT(ended.err, Contains("drape report out measures how near the preview is to the end"));
  CHECK(results_in(folder / "out")["measured"] == false);
  CHECK(results_in(folder / "out")["complete"] == true);
  CHECK(results_in(folder / "out")["methods"]["pcs"]["consistency"].empty());
  CHECK(!fs::exists(folder / "out/errors.csv"));
  CHECK(fs::is_empty(folder / "out/fields"));
  CHECK(!fs::exists(folder / "out/pictures"));
  CHECK_THAT(text_of(folder / "out/report.html"), Contains("The preview was not measured"));

  const std::string log = text_of(folder / "out/log.jsonl");
  const auto ended_at = results_in(folder / "out")["ended"];
  drape_ends("table out", folder);
  CHECK(text_of(folder / "out/log.jsonl").starts_with(log));
  CHECK(results_in(folder / "out")["ended"] == ended_at);
  check_equal(folder / "out", folder / "whole");
  CHECK(!fs::exists(folder / "out/checkpoint/state.bin"));
  const std::string results = text_of(folder / "out/results.json");
  drape_ends("report out", folder);
  CHECK(text_of(folder / "out/results.json") == results);
  CHECK(fs::exists(folder / "out/pictures/pcs_l0_on_l2.png"));
  CHECK_THAT(text_of(folder / "out/report.html"), !Contains("The preview was not measured"));
}

TEST_CASE("what was left is measured by --resume, and at once where there is something to compare with") {
  const Scratch folder(small_experiment());
  const std::string run = "run e.yaml --quiet --no-report --threads 1 ";
  drape_ends(run + "--out out --method pcs", folder);
  CHECK(results_in(folder / "out")["measured"] == false);
  CHECK_THAT(drape_ends("run --resume out --no-report --threads 1", folder).err,
             StartsWith("out: the run is complete; what it left to measure is measured now\n"));
  CHECK(!results_in(folder / "out").contains("measured"));
  CHECK(results_in(folder / "out")["methods"]["pcs"]["consistency"].size() == 1);
  drape_ends(run + "--out two --method pcs,newton", folder);
  CHECK(!results_in(folder / "two").contains("measured"));
}

TEST_CASE("a run that can no longer be measured is reported with a warning") {
  const Scratch folder(small_experiment());
  drape_ends("run e.yaml --quiet --no-report --out out --method pcs --threads 1", folder);
  folder.write("out/errors.csv", "mine\n");
  CHECK_THAT(drape_ends("table out", folder).err,
             Contains("left to measure is missing: out/errors.csv: drape did not write it, and would"));
  CHECK(text_of(folder / "out/errors.csv") == "mine\n");
  fs::remove(folder / "out/errors.csv");
  std::ofstream(folder / "out/config.yaml", std::ios::app) << "# changed\n";
  CHECK_THAT(drape_ends("table out", folder).err,
             Contains("what the run in out left to measure is missing: out/config.yaml: is not the one"));
  CHECK(results_in(folder / "out")["measured"] == false);
}

TEST_CASE("results stay complete while what was left is measured, also if that is stopped") {
  const Scratch folder;
  write_sheets(folder);
  drape_ends("run e.yaml --quiet --no-report --out out --method pcs --threads 1", folder);
  const std::string results = text_of(folder / "out/results.json");
  std::vector<std::string> warnings;
  drape::ConfigErrors errors;
  auto saved = read_saved_run(folder / "out", test_registry(), drape::LargeMemory::allowed, warnings, errors);
  drape::RunOptions options = silent(folder / "out");
  int asked = 0, changed = 0;
  options.stop = [&] {
    changed += text_of(folder / "out/results.json") != results;
    return ++asked > 0;
  };
  resume_experiment(saved->experiment, *saved->scene, options, std::move(*saved->interrupted));
  CHECK(asked > 0);
  CHECK(changed == 0);
  CHECK((text_of(folder / "out/results.json") == results));
  saved.reset();
  drape_ends("table out", folder);
  CHECK(!results_in(folder / "out").contains("measured"));
}
