// What somebody else has put where a sweep writes, and names that a shell or Slurm would read otherwise.

#include <catch2/catch.hpp>

#include "tests/support/sweep_runs.h"

namespace fs = std::filesystem;
using Catch::Contains;

namespace {

const std::string run_of_sweep = "out/runs/base/seed_1";

/// A sweep that has ended, in `out`, and a file that a link there leads to.
struct SweptWithVictim : SmallSweep {
  SweptWithVictim() {
    sweep();
    write("victim", "mine");
  }
  void link(const std::string& name) const {
    fs::remove(path / name);
    fs::create_symlink(path / "victim", path / name);
  }
};

}  // namespace

TEST_CASE("a sweep's lock is none that a link leads to, and a run's log is a new file") {
  const SweptWithVictim folder;
  folder.link("out/sweep.lock");
  CHECK(refused_by("sweep s.yaml --out out", folder.path) ==
        "error: out/sweep.lock: is not a lock of drape's; move it away\n");
  fs::remove(folder / "out/sweep.lock");
  for (const char* ending : {".log", ".status.json", ".yaml"}) {
    fs::remove_all(folder / "out/runs");
    fs::create_directories(folder / "out/runs/base");
    folder.link(run_of_sweep + ending + ".part");
    if (ending == std::string(".log")) folder.link(run_of_sweep + ending);
    folder.sweep();
    CHECK_FALSE(fs::is_symlink(folder / (run_of_sweep + ending)));
  }
  folder.link("out/sweep.json.part");
  folder.sweep();
  CHECK(text_of(folder / "victim") == "mine");
}

TEST_CASE("a sweep replaces no file beside a run that is not its own") {
  for (const char* ending : {".yaml", ".log"}) {
    const SmallSweep folder("seeds: [1]\n");
    folder.sweep();
    fs::remove_all(folder / "out/runs");
    fs::create_directories(folder / "out/runs/base");
    folder.write(run_of_sweep + ending, "mine");
    CHECK_THAT(refused_by("sweep s.yaml --out out", folder.path),
               Contains(run_of_sweep + ending + ": is there already, and not from this sweep; move it away"));
    CHECK(text_of(folder / (run_of_sweep + ending)) == "mine");
    CHECK_FALSE(fs::exists(folder / (run_of_sweep + ".status.json")));
  }
}

TEST_CASE("a sweep that was cut while it wrote the configs goes on, also with another experiment") {
  const SmallSweep folder;
  folder.sweep();
  for (const char* left : {"", ".status.json", ".log"}) fs::remove_all(folder / (run_of_sweep + left));
  folder.sweep();  // the config alone, as an earlier version left it
  folder.write(run_of_sweep + ".status.json",
               R"({"status":"pending","error":"","exit_code":0,"seconds":0,"starts":0,"threads":0})");
  for (const char* left : {"", ".log"}) fs::remove_all(folder / (run_of_sweep + left));
  folder.write("e.yaml", replaced(text_of(folder / "e.yaml"), "columns: 6", "columns: 5"));
  folder.sweep();
}

TEST_CASE("a sweep does not write into a folder that is a link, of whatever depth") {
  for (const std::string part : {"out/runs", "out/runs/base", "out/runs/base/seed_1"}) {
    const SmallSweep folder;
    folder.sweep();
    fs::create_directories(folder / "photos/base");
    folder.write("photos/base/seed_1.yaml", "mine");
    fs::remove_all(folder / part);
    fs::create_directory_symlink(folder / "photos", folder / part);
    CHECK_THAT(
        refused_by("sweep s.yaml --out out", folder.path),
        Contains(part +
                 ": is a link, and drape writes into folders of its own; remove it, or make it a folder"));
    CHECK(std::distance(fs::directory_iterator(folder / "photos"), fs::directory_iterator()) == 1);
  }
}

TEST_CASE("a folder's name becomes no line of a job's script, and no pattern of Slurm's") {
  const SmallSweep folder;
  for (const std::string name : {"a$'\\n'touch", "'a\"b'", "100%a", "'a\\b'", "a$'\\x7f'"})
    CHECK_THAT(refused_by("sweep s.yaml --engine slurm --out " + name, folder.path),
               Contains("its name has a control character, \", \\ or %, which the scripts of Slurm's jobs"));
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 2);
}

TEST_CASE("what sbatch answers is a job's number, or nothing was submitted") {
  const SmallSweep folder;
  folder.write("sbatch", "#!/bin/sh\nprintf '%b\\n' \"$ANSWER\"\n");
  fs::permissions(folder / "sbatch", fs::perms::owner_all);
  const auto said = [&](const std::string& answer) {
    fs::remove_all(folder / "out");
    return drape_with("sweep s.yaml --engine slurm --out out", folder.path,
                      "PATH=" + folder.path.string() + ":$PATH ANSWER='" + answer + "'");
  };
  for (const std::string answer : {"", "slurm-wlm 22.05", "--all", "12 13", "\\033[31m12"}) {
    CAPTURE(answer);
    const Ended ended = said(answer);
    CHECK(ended.exit_code == 3);
    CHECK_THAT(ended.out, !Contains("submitted"));
    CHECK_THAT(ended.err, Contains("no job's number; take out what of --sbatch") && !Contains("\033"));
    CHECK_FALSE(fs::exists(folder / "out/slurm/jobs.json"));
  }
  CHECK_THAT(said("12;cluster").out, Contains("submitted: 1 runs as job array 12, collected by job 12;"));
}

TEST_CASE("an --sbatch that is no option is refused, since sbatch would run what follows as its script") {
  const SmallSweep folder;
  for (const std::string word : {"foo", "-", "--"})
    CHECK_THAT(refused_by("sweep s.yaml --engine slurm --out out --sbatch=" + word, folder.path),
               Contains("--sbatch " + word + ": an option of sbatch begins with -"));
  CHECK_FALSE(fs::exists(folder / "out"));
}

TEST_CASE("a folder without a sweep is said to be one") {
  const Scratch folder;
  for (const std::string options : {"", " --task 0"})
    CHECK(refused_by("sweep-job ." + options, folder.path) ==
          "error: .: has no sweep.json; is it a sweep's folder?\n");
}

TEST_CASE("what is cancelled is a job's number") {
  const SmallSweep folder;
  folder.sweep();
  fs::create_directory(folder / "out/slurm");
  folder.write("out/slurm/jobs.json", R"({"array": "--user=me", "collector": "8"})");
  CHECK_THAT(refused_by("sweep s.yaml --out out --engine slurm --cancel", folder.path),
             Contains("jobs.json: a job is a number, not --user=me; see which of its jobs are in the queue"));
}

TEST_CASE("a sweep.json leads to no run outside of its folder") {
  const SmallSweep folder("seeds: [1]\n");
  folder.sweep();
  fs::rename(folder / run_of_sweep, folder / "other");
  fs::remove(folder / "other/report.html");
  const std::string text = text_of(folder / "out/sweep.json"), own = "\"runs/base/seed_1\"";
  fs::create_directory_symlink("../../../other", folder / run_of_sweep);
  const std::string absolute = fs::absolute(folder / "other").string();
  for (const std::string& named : {std::string("../other"), absolute, std::string("runs/base/seed_1")}) {
    CAPTURE(named);
    folder.write("out/sweep.json", replaced(text, own, "\"" + named + "\""));
    for (const std::string command : {"report out", "table out", "sweep s.yaml --out out"})
      CHECK_THAT(refused_by(command, folder.path),
                 Contains("out") && (Contains("leads out of") || Contains("is a link")));
    CHECK_FALSE(fs::exists(folder / "other/report.html"));
  }
}
