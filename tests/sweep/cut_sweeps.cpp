// Sweeps that were cut: what the same command resumes, begins again, or leaves.

#include <catch2/catch.hpp>

#include "tests/support/sweep_runs.h"

namespace {

/// A sweep of one run, "slow", of some hundred steps.
void write_slow(const Scratch& folder) {
  folder.write("e.yaml", small_experiment());
  folder.write(
      "s.yaml",
      "name: s\nbase: e.yaml\nset: {levels: 1, newton: {step_size: 1e-3, step_growth: 1, force_tolerance: "
      "1e-9, max_steps: 400}}\nmethods: [newton]\nablation:\n  - {name: slow}\n");
}

/// Begins the sweep, and ends it by a signal as soon as its run has a checkpoint.
void cut_slow(const Scratch& folder, int signal) {
  DrapeAtWork command("sweep s.yaml --out out", folder);
  command.wait_until("the run has a checkpoint", [&] {
    return std::filesystem::exists(folder / "out/runs/slow/seed_1/checkpoint/state.bin");
  });
  command.send(signal);
  REQUIRE(command.wait().exit_code == 128 + signal);
}

}  // namespace

TEST_CASE("a run that was stopped resumes from its checkpoint, to the bits of an uninterrupted one") {
  const Scratch folder;
  write_slow(folder);
  drape_with("sweep s.yaml --out whole", folder.path);
  cut_slow(folder, SIGINT);
  REQUIRE(runs_of(folder / "out")[0]["status"] == "cancelled");
  drape_with("sweep s.yaml --out out", folder.path);
  CHECK(runs_of(folder / "out")[0]["starts"] == 2);
  CHECK_THAT(text_of(folder / "out/runs/slow/seed_1/log.jsonl"), Catch::Contains("\"run_resumed\""));
  CHECK(outcome_of(folder / "out") == outcome_of(folder / "whole"));
}

TEST_CASE("a sweep that was killed runs an experiment that has changed since from its beginning") {
  const Scratch folder;
  write_slow(folder);
  cut_slow(folder, SIGKILL);
  folder.write("s.yaml", replaced(text_of(folder / "s.yaml"), "max_steps: 400", "max_steps: 3"));
  drape_with("sweep s.yaml --out out", folder.path);
  const auto results = json_in(folder / "out/runs/slow/seed_1/results.json");
  CHECK(results["methods"]["newton"]["levels"][0]["steps"] == 3);
  CHECK_THAT(text_of(folder / "out/runs/slow/seed_1/log.jsonl"), !Catch::Contains("\"run_resumed\""));
}

TEST_CASE("a sweep removes no run that another process is resuming") {
  const Scratch folder;
  write_slow(folder);
  cut_slow(folder, SIGKILL);
  const std::string run = "out/runs/slow/seed_1";
  DrapeAtWork by_hand("run --resume " + run + " --no-report", folder);
  by_hand.wait_until("it resumes", [&] {
    return text_of(folder / (run + "/log.jsonl")).find("run_resumed") != std::string::npos;
  });
  by_hand.send(SIGSTOP);
  folder.write(run + "/notes", "mine");
  folder.write("s.yaml", replaced(text_of(folder / "s.yaml"), "max_steps: 400", "max_steps: 3"));
  drape_with("sweep s.yaml --out out", folder.path);
  CHECK(text_of(folder / (run + "/notes")) == "mine");
  CHECK(runs_of(folder / "out")[0]["status"] == "failed");
  CHECK_THAT(runs_of(folder / "out")[0]["error"].get<std::string>(), Catch::Contains("uses this folder"));
  by_hand.send(SIGCONT);
  by_hand.send(SIGINT);
  by_hand.wait();
}

TEST_CASE("a run that was resumed without its sweep is one of the sweep's results") {
  const Scratch folder;
  write_slow(folder);
  cut_slow(folder, SIGINT);
  drape_with("run --resume out/runs/slow/seed_1", folder.path);
  folder.write("out/runs/slow/seed_1/notes", "mine");
  drape_with("sweep s.yaml --out out", folder.path);
  CHECK(runs_of(folder / "out")[0]["status"] == "not_converged");
  CHECK(runs_of(folder / "out")[0]["starts"] == 1);
  CHECK(text_of(folder / "out/runs/slow/seed_1/notes") == "mine");
}

TEST_CASE("a run that failed and was completed without its sweep is one of the sweep's results") {
  const Scratch folder;
  write_slow(folder);
  cut_slow(folder, SIGINT);
  const std::string run = "out/runs/slow/seed_1", status = run + ".status.json";
  folder.write(status, replaced(text_of(folder / status), "cancelled", "failed"));
  drape_with("run --resume " + run, folder.path);
  folder.write(run + "/notes", "mine");
  drape_with("sweep s.yaml --out out --retry-failed", folder.path);
  CHECK(runs_of(folder / "out")[0]["status"] == "not_converged");
  CHECK(text_of(folder / (run + "/log.jsonl")).find("run_resumed") != std::string::npos);
  CHECK(text_of(folder / (run + "/notes")) == "mine");
}

TEST_CASE("a sweep replaces no complete results that it did not make") {
  const Scratch folder;
  write_slow(folder);
  cut_slow(folder, SIGINT);
  const std::string run = "out/runs/slow/seed_1", status = run + ".status.json";
  drape_with("run --resume " + run, folder.path);
  folder.write(
      status,
      R"({"status": "failed", "error": "", "exit_code": 2, "seconds": 0, "starts": 1, "threads": 1})");
  const std::string results = text_of(folder / (run + "/results.json"));
  CHECK_THAT(refused_by("sweep s.yaml --out out --retry-failed", folder.path),
             Catch::Contains(run + ": has complete results, but not from this sweep"));
  CHECK(text_of(folder / (run + "/results.json")) == results);
}

TEST_CASE("a sweep starts no run once its program was replaced, and the same command runs the rest") {
  const Scratch folder;
  std::filesystem::create_directory(folder / "bin");
  std::filesystem::copy_file(drape_command, folder / "bin/drape");
  std::filesystem::copy_file(drape_command, folder / "bin/new");
  std::filesystem::create_directory_symlink(std::filesystem::path(drape_command).parent_path() / "../lib",
                                            folder / "lib");
  folder.write("e.yaml", small_experiment());
  folder.write("s.yaml", coarsest_by_newton + "repeats: 20\n");
  Command command("exec bin/drape sweep s.yaml --out out --workers 1", folder.path);
  wait_for(command, folder / "out", "converged", 1);
  std::filesystem::rename(folder / "bin/new", folder / "bin/drape");
  const Ended ended = command.wait();
  CHECK(ended.exit_code == 3);
  CHECK_THAT(ended.err, Catch::Contains("bin/drape was replaced or removed while the sweep ran"));
  CHECK(count_of(runs_of(folder / "out"), "failed") == 0);
  CHECK(count_of(runs_of(folder / "out"), "pending") > 0);
  drape_ends("sweep s.yaml --out out", folder);
  CHECK(count_of(runs_of(folder / "out"), "converged") == 20);
}

TEST_CASE("a sweep's folders may have wildcards in their names, and bytes that are not UTF-8") {
  const Scratch folder;
  const std::string name = "cloth [v2] caf\xe9";
  std::filesystem::create_directory(folder / name);
  folder.write(name + "/e1.yaml", small_experiment());
  for (const std::string files : {"e1.yaml", "e*.yaml"}) {
    folder.write(name + "/s.yaml",
                 "name: s\nexperiments: [" + files + "]\nset: {levels: 1}\nmethods: [newton]\n");
    CHECK(drape_ends("sweep '" + name + "/s.yaml' --out out -q", folder).err == "");
  }
}
