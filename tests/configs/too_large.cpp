// Values beyond what can be computed with, and scenes beyond what the machine holds: refused by name before
// anything is built, never computed until memory or patience ends.

#include <catch2/catch.hpp>

#include "tests/support/command.h"

using Catch::Contains;

TEST_CASE("an obstacle with coordinates beyond what can be computed with is refused") {
  const Scratch folder;
  folder.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1e30 0\nf 1 2 3\n");
  folder.write("e.yaml", replaced(small_experiment(), "levels: 2\n",
                                  "levels: 2\ncontact: ipc\nobstacles: [{mesh: far.obj}]\n"));
  CHECK_THAT(
      refused_by("check e.yaml", folder.path),
      Contains(
          "far.obj: 1 vertex has too large a coordinate: 2 with 1e+30 m (counted from 0); at most 1e+09 m"));
}

TEST_CASE(
    "a run that may take more memory than there is, is refused before anything is built, unless allowed") {
  const Scratch folder(small_experiment());
  CHECK_THAT(refused_by("check e.yaml --levels 10 --set cloth.columns=12 --set cloth.rows=12", folder.path),
             Catch::Matches(
                 "error: --levels: level 9 would have about 3\\.2e\\+07 vertices and take about 1582 GB of "
                 "memory, where this machine has [0-9.]+ GB; take at most [0-9] levels, or allow it with "
                 "--allow-memory\n"));

  // The shell's limit is the machine's. Sanitizers ask for terabytes of addresses.
  if (DRAPE_SANITIZED) return;
  const std::string line = "ulimit -v 2900000; exec " + drape_command +
                           " check e.yaml --levels 1 --set cloth.columns=300 --set cloth.rows=300";
  const Ended ended = Command(line, folder.path).wait();
  CHECK(ended.exit_code == 2);
  CHECK(ended.err ==
        "error: --levels: level 0 would have about 90000 vertices and take about 3.1 GB of memory, where "
        "this machine has 3.0 GB; ask for fewer vertices, or allow it with --allow-memory\n");
  const Ended allowed = Command(line + " --allow-memory", folder.path).wait();
  CHECK(allowed.err == "");
  CHECK(allowed.exit_code == 0);
  CHECK_THAT(allowed.out, Contains("Vertices by level: 90000\nMemory to solve them, at most about: 3.1 GB"));
}
