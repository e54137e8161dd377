// Sweeps that were cut: what the same command resumes, begins again, or leaves.

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>

#include "core/app/sweep/process.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/sweep_runs.h"

namespace fs = std::filesystem;

namespace {

const std::string sweep_slow = "sweep s.yaml --out out";
const std::string slow_run = "out/runs/slow/seed_1";

/// A sweep of one run, "slow", of some hundred steps, which a signal ends as soon as it has a checkpoint.
struct CutSweep : Scratch {
  explicit CutSweep(int signal) : Scratch(small_experiment()) {
    write("s.yaml",
          "name: s\nbase: e.yaml\nset: {levels: 1, newton: {step_size: 1e-3, step_growth: 1, "
          "force_tolerance: 1e-9, max_steps: 400}}\nmethods: [newton]\nablation:\n  - {name: slow}\n");
    DrapeAtWork command(sweep_slow, *this);
    command.wait_until("the run has a checkpoint",
                       [&] { return fs::exists(path / slow_run / "checkpoint/state.bin"); });
    command.send(signal);
    REQUIRE(command.wait().exit_code == 128 + signal);
  }
  /// Lets the run end after three steps.
  void shorten() const {
    write("s.yaml", replaced(text_of(path / "s.yaml"), "max_steps: 400", "max_steps: 3"));
  }
  nlohmann::json run() const { return runs_of(path / "out")[0]; }
  std::string log() const { return text_of(path / slow_run / "log.jsonl"); }
};

}  // namespace

TEST_CASE("a run that was stopped resumes from its checkpoint, to the bits of an uninterrupted one") {
  const CutSweep folder(SIGINT);
  REQUIRE(folder.run()["status"] == "cancelled");
  drape_with(sweep_slow, folder.path);
  CHECK(folder.run()["starts"] == 2);
  CHECK_THAT(folder.log(), Catch::Contains("\"run_resumed\""));
  drape_with("sweep s.yaml --out whole", folder.path);
  CHECK(outcome_of(folder / "out") == outcome_of(folder / "whole"));
}

TEST_CASE("a sweep that was killed runs an experiment that has changed since from its beginning") {
  const CutSweep folder(SIGKILL);
  folder.shorten();
  drape_with(sweep_slow, folder.path);
  const auto results = json_in(folder / (slow_run + "/results.json"));
  CHECK(results["methods"]["newton"]["levels"][0]["steps"] == 3);
  CHECK_THAT(folder.log(), !Catch::Contains("\"run_resumed\""));
}

TEST_CASE("a run that another process is resuming stays, and is one of the results of the next sweep") {
  const bool changes = GENERATE(false, true);
  const CutSweep folder(SIGKILL);
  DrapeAtWork by_hand("run --resume " + slow_run + " --no-report --measure", folder);
  by_hand.wait_until("it resumes", [&] { return folder.log().find("run_resumed") != std::string::npos; });
  by_hand.send(SIGSTOP);
  folder.write(slow_run + "/notes", "mine");
  if (changes) folder.shorten();
  drape_with(sweep_slow, folder.path);
  CHECK(text_of(folder / (slow_run + "/notes")) == "mine");
  CHECK(folder.run()["status"] == "failed");
  CHECK_THAT(folder.run()["error"].get<std::string>(), Catch::Contains("uses this folder"));
  by_hand.send(SIGCONT);
  if (changes) by_hand.send(SIGINT);
  by_hand.wait();
  if (changes) return;  // the run is of another experiment than the sweep's
  drape_with(sweep_slow, folder.path);
  CHECK(folder.run()["status"] == "not_converged");
}

TEST_CASE("a sweep that was cut while its runs' files were written goes on") {
  const SmallSweep folder;
  fs::create_directories(folder / "out/runs/base/seed_1.yaml");  // no file can be written here
  folder.write("out/sweep.lock", "");
  CHECK(drape_with("sweep s.yaml --out out", folder.path).exit_code > 1);
  fs::remove_all(folder / "out/runs/base/seed_1.yaml");
  folder.sweep();
}

TEST_CASE("a run that was completed without its sweep is one of the sweep's results, whatever its status") {
  const std::string word = GENERATE("cancelled", "failed", "running");
  const CutSweep folder(SIGINT);
  const std::string status = slow_run + ".status.json";
  folder.write(status, replaced(text_of(folder / status), "cancelled", word));
  drape_with("run --resume " + slow_run, folder.path);
  folder.write(slow_run + "/notes", "mine");
  drape_with(sweep_slow + (word == "failed" ? " --retry-failed" : ""), folder.path);
  CHECK(folder.run()["status"] == "not_converged");
  CHECK(folder.run()["starts"] == 1);
  CHECK(text_of(folder / (slow_run + "/notes")) == "mine");
}

TEST_CASE("a sweep replaces no complete results that it did not make") {
  const CutSweep folder(SIGINT);
  drape_with("run --resume " + slow_run, folder.path);
  folder.write(
      slow_run + ".status.json",
      R"({"status": "failed", "error": "", "exit_code": 2, "seconds": 0, "starts": 1, "threads": 1})");
  const std::string results = text_of(folder / (slow_run + "/results.json"));
  CHECK_THAT(refused_by(sweep_slow + " --retry-failed", folder.path),
             Catch::Contains(slow_run + ": has complete results, but not from this sweep"));
  CHECK(text_of(folder / (slow_run + "/results.json")) == results);
}

TEST_CASE("a signal ends a run that has only just been started") {
  const Scratch folder;
  const auto before =
      std::signal(SIGINT, [](int) {});  // as a sweep's, which its children have until they begin
  for (int k = 0; k < 50; ++k) {
    const drape::Process run({"sleep", "2"}, folder / "out", folder / "err");
    run.signal(SIGINT);
    REQUIRE(run.wait().signal == SIGINT);
  }
  std::signal(SIGINT, before);
}

TEST_CASE("the time of a start that was killed counts") {
  const CutSweep folder(SIGKILL);
  const fs::path status = folder / (slow_run + ".status.json");
  fs::last_write_time(status, fs::last_write_time(status) - std::chrono::seconds(100));
  drape_with(sweep_slow, folder.path);
  CHECK(folder.run()["seconds"].get<double>() > 99);
}

TEST_CASE("a sweep starts no run once its program was replaced, and the same command runs the rest") {
  const SmallSweep folder("repeats: 20\n");
  copy_program(folder);
  Command command("exec bin/drape sweep s.yaml --out out --workers 1", folder.path);
  wait_for(command, folder / "out", "converged", 1);
  replace_program(folder);
  const Ended ended = command.wait();
  CHECK(ended.exit_code == 3);
  CHECK_THAT(ended.err,
             Catch::Contains("bin/drape or a library of it was replaced or removed while the sweep ran"));
  CHECK(count_of(folder.runs(), "failed") == 0);
  CHECK(count_of(folder.runs(), "pending") > 0);
  folder.sweep();
  CHECK(count_of(folder.runs(), "converged") == 20);
}

TEST_CASE("a sweep's folders may have wildcards in their names, and bytes that are not UTF-8") {
  const Scratch folder;
  const std::string name = "cloth [v2] caf\xe9";
  fs::create_directory(folder / name);
  folder.write(name + "/e1.yaml", small_experiment());
  for (const std::string files : {"e1.yaml", "e*.yaml"}) {
    folder.write(name + "/s.yaml",
                 "name: s\nexperiments: [" + files + "]\nset: {levels: 1}\nmethods: [newton]\n");
    CHECK(drape_ends("sweep '" + name + "/s.yaml' --out out -q", folder).err == "");
  }
  // An obstacle's file in such a folder cannot be named in a config.yaml.
  drape::write_mesh(folder.path / name / "ball.ply", drape::unit_sphere(1));
  folder.write(name + "/e2.yaml",
               small_experiment() +
                   "\ncontact: ipc\nobstacles: [{name: ball, mesh: ball.ply, translate: [0, 0, -3]}]\n");
  CHECK_THAT(refused_by("run '" + name + "/e2.yaml' --out other", folder.path), Catch::Contains("no UTF-8"));
  CHECK_FALSE(fs::exists(folder / "other"));
}
