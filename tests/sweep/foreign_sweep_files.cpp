// What somebody else has put where a sweep writes.

#include <catch2/catch.hpp>

#include "tests/support/sweep_runs.h"

namespace fs = std::filesystem;

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
