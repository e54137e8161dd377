// Values beyond what can be computed with, and scenes beyond what the machine holds: refused by name before
// anything is built, never computed until memory or patience ends.

#include <catch2/catch.hpp>

#include "tests/support/command.h"

using Catch::Contains;
using Catch::Matches;
using Catch::StartsWith;

namespace {

/// What `drape check` says to an experiment with these settings, which it must refuse.
std::string check_refusal(const Scratch& folder, const std::string& sets) {
  return refused_by("check e.yaml " + sets, folder.path);
}

std::string check_refusal(const std::string& sets) {
  const Scratch folder;
  folder.write("e.yaml", small_experiment());
  return check_refusal(folder, sets);
}

/// The same of one key, whose range the message must give with the value.
void check_out_of_range(const std::string& key, const std::string& value, const std::string& range) {
  const std::string name = key.substr(key.rfind('.') + 1);
  const std::string said = check_refusal("--set '" + key + "=" + value + "'");
  CHECK_THAT(said, Contains("\"" + name + "\" must be " + range + ", not "));
}

std::string with(const std::string& more) {
  return replaced(small_experiment(), "levels: 2\n", "levels: 2\n" + more + "\n");
}

}  // namespace

TEST_CASE("numbers that overflow, or never end, are refused by name with their bound") {
  check_out_of_range("newton.step_size", "1e200", "at most 1.0e+09 s");
  check_out_of_range("newton.iterations_per_step", "2147483647", "at most 1000");
  check_out_of_range("material.density", "1e300", "at most 1.0e+06 kg/m³");
  check_out_of_range("material.density", "1e-300", "at least 1.0e-06 kg/m³");
  check_out_of_range("material.membrane_modulus", "1e300", "at most 1.0e+13 Pa");
  check_out_of_range("material.bending_modulus", "1e300", "at most 1.0e+13 Pa");
  check_out_of_range("material.thickness", "1e30", "at most 10 m");
  check_out_of_range("start.translate", "[0, 0, 1e20]", "at most 1.0e+09 m");
  check_out_of_range("start.translate", "[-1e20, 0, 0]", "at least -1.0e+09 m");
  check_out_of_range("cloth.columns", "2000000000", "at most 1.0e+07");
  CHECK(check_refusal("--set 'energies=[neo_hookean, {type: gravity, acceleration: [0, 0, -1e300]}]'") ==
        "error: --set energies: item 3 of \"acceleration\" must be at least -1.0e+07 m/s², not -1e300\n");
  CHECK(check_refusal("--set 'metrics=[{type: curvature_consistency, rings: 2147483647}]'") ==
        "error: --set metrics: \"rings\" must be at most 50, not 2147483647\n");
}

TEST_CASE("contact's numbers too") {
  const auto said = [](const std::string& contact) {
    const Scratch folder;
    folder.write("e.yaml", with("contact: " + contact));
    const std::string text = check_refusal(folder, "");
    return text.substr(text.find('"'));
  };
  CHECK(said("{type: ipc, dhat: 1e39}") == "\"dhat\" must be at most 1000 m, not 1e39\n");
  CHECK(said("{type: shapes, dhat: 1e39}") == "\"dhat\" must be at most 1000 m, not 1e39\n");
  const auto cages = [&](const std::string& text) {
    return said("ipc\nobstacles: [{meshed_shape: sphere, translate: [0, 0, -3], cages: {count: 2, " + text +
                "}}]");
  };
  CHECK(cages("growth: 1e40") == "\"growth\" must be at most 10, not 1e40\n");
  CHECK_THAT(cages("alpha: 1e-9, offset: 1e-9"),
             Contains("\"alpha\" must be at least 0.005, not 1e-9\n") &&
                 Contains("\"offset\" must be at least 1.0e-04, not 1e-9\n"));
  CHECK(said("ipc\nobstacles: [{meshed_shape: box, size: [1, 1e40, 1]}]") ==
        "\"size\" must be at most 1.0e+06 m, not 1e40\n");
}

TEST_CASE("a mesh with coordinates beyond what can be computed with is refused, cloth or obstacle") {
  const Scratch folder;
  folder.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1e30 0\nf 1 2 3\n");
  folder.write("e.yaml", replaced(small_experiment(), "shape: square, side: 1, columns: 6, rows: 6",
                                  "shape: file, file: far.obj"));
  CHECK_THAT(
      check_refusal(folder, ""),
      StartsWith("error: e.yaml:2:8: far.obj: 1 vertex has too large a coordinate: 2 with 1e+30 m (counted "
                 "from 0); at most 1e+09 m can be computed with: is the file in metres?\n"));
  folder.write("e.yaml", with("contact: ipc\nobstacles: [{mesh: far.obj}]"));
  CHECK_THAT(
      check_refusal(folder, ""),
      Contains(
          "far.obj: 1 vertex has too large a coordinate: 2 with 1e+30 m (counted from 0); at most 1e+09 m"));
}

TEST_CASE("a cloth whose vertices cannot be about as many as asked for is refused with both numbers") {
  const auto said = [](const std::string& cloth) {
    const Scratch folder;
    folder.write("e.yaml",
                 replaced(small_experiment(), "shape: square, side: 1, columns: 6, rows: 6", cloth));
    return check_refusal(folder, "");
  };
  CHECK(said("shape: rectangle, size: [1e6, 1e-6]") ==
        "error: e.yaml:2:8: rectangle: about 1024 vertices are asked for, but its grid of even cells "
        "has 3.2e+07 × 2 = 6.4e+07; set columns and rows, or ask for another number of vertices\n");
  CHECK_THAT(said("shape: polygon, loops: [{points: [0, 0, 1, 0, 0, 1e-9]}], vertices: 10"),
             Contains("polygon: about 10 vertices are not possible; the nearest number is above "));
}

TEST_CASE(
    "a run that may take more memory than there is, is refused before anything is built, unless allowed") {
  CHECK_THAT(
      check_refusal("--levels 10 --set cloth.columns=12 --set cloth.rows=12"),
      Matches("error: --levels: level 9 would have about 3\\.2e\\+07 vertices and take about 1582 GB of "
              "memory, where this machine has [0-9.]+ GB; take at most [0-9] levels, or allow it with "
              "--allow-memory\n"));
  CHECK_THAT(check_refusal("--levels 10 --allow-memory --set cloth.columns=1000 --set cloth.rows=1000"),
             Contains("level 9 would have about 2.6e+11 vertices, more than the 4e+07 that can be counted"));

  // The shell's limit is the machine's. Sanitizers ask for terabytes of addresses.
  if (test_slowdown() > 1) return;
  const Scratch folder;
  folder.write("e.yaml", small_experiment());
  const std::string line = "ulimit -v 2900000; exec " + drape_command +
                           " check e.yaml --levels 1 --set cloth.columns=300 --set cloth.rows=300";
  const Ended ended = Command(line, folder.path).wait();
  CHECK(ended.exit_code == 2);
  CHECK(ended.err ==
        "error: --levels: level 0 would have about 90000 vertices and take about 3.1 GB of memory, where "
        "this "
        "machine has 3.0 GB; ask for fewer vertices, or allow it with --allow-memory\n");
  const Ended allowed = Command(line + " --allow-memory", folder.path).wait();
  CHECK(allowed.err == "");
  CHECK(allowed.exit_code == 0);
  CHECK_THAT(allowed.out, Contains("Vertices by level: 90000\nMemory to solve them, at most about: 3.1 GB"));
}
