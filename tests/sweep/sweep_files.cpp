// What `drape sweep` says to bad sweep files and options. Nothing may be written in any case.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/kernel/threads/parallel.h"
#include "tests/support/folders.h"
#include "tests/support/sweep_runs.h"

namespace fs = std::filesystem;

namespace {

/// Standard error of a sweep that must be refused, and leave nothing behind.
std::string said_of(const std::string& sweep, const std::string& arguments = "") {
  const Scratch folder(small_experiment());
  folder.write("s.yaml", "name: s\nbase: e.yaml\n" + sweep);
  const std::string said = refused_by("sweep s.yaml --out out " + arguments, folder.path);
  CHECK(!fs::exists(folder / "out"));
  return said;
}

/// The sweep must be refused with this fault of its file, and no other.
void refuses(const std::string& sweep, const std::string& fault) {
  INFO(sweep);
  const std::string said = said_of(sweep);
  CHECK_THAT(said, Catch::StartsWith("error: s.yaml:" + fault));
  CHECK(std::count(said.begin(), said.end(), '\n') == 1);
}

}  // namespace

TEST_CASE("the shape of an ablation") {
  for (const char* none : {"[]", "coarse"})
    refuses(std::string("ablation: ") + none + "\n",
            R"(3:11: "ablation" must be a list of variations, as in )");
  refuses("ablation: {grid: [1]}\n", R"(3:18: "grid" must be a map of paths of keys and lists of values)");
  const std::string ten = ": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]";
  std::string grid = "levels" + ten;
  for (const std::string key : {"max_steps", "step_size", "iterations_per_step", "step_growth"})
    grid += ", newton." + key + ten;
  refuses("ablation: {grid: {" + grid + "}}\n", "3:18: the grid has more than 10000 variations; ");
}

TEST_CASE("a sweep of very many runs is refused, and a long list is one in memory") {
  const auto tenths = [](int count) {
    std::string list = "[0.1";
    for (int k = 1; k < count; ++k) list += ", 0." + std::to_string(10'000'000 + k);
    return list + "]";
  };
  refuses(
      "repeats: 10000\nablation: {grid: {newton.step_size: " + tenths(100) + "}}\n",
      "3:10: the sweep has 1000000 runs, and may have 100000; take fewer seeds, variations or experiments");
  const Scratch folder(small_experiment());
  folder.write("s.yaml",
               "name: s\nbase: e.yaml\nablation: {grid: {newton.step_size: " + tenths(4000) + "}}\n");
  CHECK(Command("ulimit -v 2000000; exec " + drape_command + " sweep s.yaml --dry-run", folder.path)
            .wait()
            .exit_code == 0);
}

TEST_CASE("runs whose experiments are long have a bound together") {
  const Scratch folder(small_experiment());
  const std::string start = "name: s\nbase: e.yaml\nset: {start.perturbation: 1e-3, pins: [";
  std::string pins = "{region: nearest, point: [0, 0, 0]}";
  for (int k = 1; k < 300; ++k) pins += ", {region: nearest, point: [0, " + std::to_string(k) + ", 0]}";
  folder.write("s.yaml", start + pins + "]}\nrepeats: 10000\n");
  CHECK_THAT(refused_by("check s.yaml", folder.path),
             Catch::Contains("have more than 500 MB of text together; "));
}

TEST_CASE("a base that is no text has one fault") {
  const Scratch folder(small_experiment());
  folder.write("s.yaml", "name: s\nbase: [e.yaml]\n");
  CHECK(refused_by("sweep s.yaml", folder.path) == "error: s.yaml:2:7: \"base\" must be text, not a list\n");
}

TEST_CASE("two equal variations") {
  const std::string same = R"(variations "a" and "b" come to the same experiment; take one of them out)";
  refuses("ablation: [{name: a}, {name: b, levels: 2}]\n", "3:30: " + same);
  refuses("repeats: 2\nset: {start.perturbation: 1e-3}\nablation: [{name: a}, {name: b}]\n", "5:30: " + same);
  refuses("methods: [pcs]\nablation: [{name: a}, {name: b, set: {methods.newton.newton.max_steps: 2}}]\n",
          "4:30: " + same);
}

TEST_CASE("a sweep with a run that may exceed the memory starts no run") {
  CHECK_THAT(said_of("methods: [newton]\nablation:\n  - {name: small, levels: 1}\n"
                     "  - {name: large, levels: 10, set: {cloth.columns: 12, cloth.rows: 12}}\n"),
             Catch::Matches(
                 "error: large, seed 1, may need 1582 GB of memory, where this machine has [0-9.]+ GB; take "
                 "fewer levels or vertices, or allow it with --allow-memory\n"));
}

TEST_CASE("conflicting options, and a foreign folder") {
  const int cores = drape::core_count();
  const std::string more = std::to_string(cores + 1),
                    rest = " threads (workers × threads) are more than the " + std::to_string(cores) +
                           " cores that this process may use; lower --workers or --threads\n";
  CHECK(said_of("", "--workers " + more) == "error: " + more + " × 1" + rest);
  CHECK(said_of("threads: " + more + "\n") == "error: 1 × " + more + rest);
  CHECK(said_of("", "--wait") == "error: --wait is of --engine slurm; give that too\n");
  CHECK(said_of("", "--engine slurm --cancel") ==
        "error: out: has no jobs in Slurm's queue; there is nothing to cancel\n");

  const SmallSweep folder;
  fs::create_directory(folder / "mine");
  folder.write("mine/notes", "mine");
  CHECK(refused_by("sweep s.yaml --out mine", folder.path) ==
        "error: mine: holds notes, and no sweep; name another folder with --out\n");
  CHECK(!fs::exists(folder / "mine/sweep.lock"));  // by which a run would take the folder for a sweep's
  CHECK(drape_with("sweep s.yaml --out s.yaml", folder.path).err ==
        "error: s.yaml: cannot make the results folder (Not a directory); name another with --out\n");
  folder.sweep();
  folder.write("other.yaml", "name: other\nbase: e.yaml\n");
  CHECK(drape_with("sweep other.yaml --out out", folder.path).err ==
        "error: out: holds the sweep \"s\"; name another folder with --out\n");
}

TEST_CASE("--dry-run foresees the refusal that the sweep would meet") {
  const Scratch folder(small_experiment());
  folder.write("s.yaml", "name: s\nbase: e.yaml\nmethods: [newton]\nset: {levels: 1}\n");
  const auto alike = [&](const std::string& sweep, const std::string& refusal) {
    const std::string limited = "ulimit -v 8000000; exec " + drape_command + " sweep " + sweep;
    const Ended dry = Command(limited + " --dry-run", folder.path).wait(),
                real = Command(limited, folder.path).wait();
    CHECK(dry.exit_code == 2);
    CHECK_THAT(dry.out, Catch::StartsWith("sweep "));
    CHECK_THAT(dry.err, Catch::Contains(refusal));
    CHECK(dry.err == real.err);
  };
  folder.write("large.yaml",
               "name: large\nbase: e.yaml\nmethods: [newton]\nset: {cloth.columns: 1500, cloth.rows: "
               "1500, levels: 1}\n");
  alike("large.yaml",
        " of memory, where this machine has 8.2 GB; take fewer levels or vertices, or allow it");
  CHECK(drape_with("sweep large.yaml --dry-run --allow-memory", folder.path).exit_code == 0);
  fs::create_directory(folder / "mine");
  folder.write("mine/notes.txt", "mine");
  alike("s.yaml --out mine", "mine: holds notes.txt, and no sweep; name another folder with --out");
  drape_ends("sweep s.yaml --out out", folder);
  folder.write("other.yaml", "name: other\nbase: e.yaml\nmethods: [newton]\nset: {levels: 1}\n");
  alike("other.yaml --out out", "out: holds the sweep \"s\"; name another folder with --out");
  folder.write("s.yaml", "name: s\nbase: e.yaml\nmethods: [newton]\nset: {levels: 2}\n");
  alike("s.yaml --out out", "are of another experiment than the sweep now says");
}

TEST_CASE("--dry-run validates and lists without writing, and --most-levels limits the levels") {
  const Scratch folder(small_experiment());
  folder.write("s.yaml",
               "name: s\nbase: e.yaml\nmethods: [newton]\n"
               "ablation: {grid: {levels: [1, 3], newton.step_growth: [1.5]}}\n");
  const auto plan = [&](const std::string& option) {
    return shown_by("sweep s.yaml --dry-run" + option, folder.path);
  };
  using Catch::Contains;
  const std::string
      coarse =
          "sweep s: 2 runs in results/s, each with 1 thread\n"
          "pending    runs/levels=1,step_growth=1.5/seed_1  levels 1, about 36 vertices, 0.1 GB  "
          "{\"levels\":1,\"newton.step_growth\":1.5}\n",
      fine = "pending    runs/levels=3,step_growth=1.5/seed_1  levels ";
  CHECK_THAT(plan(""), Catch::StartsWith(coarse) && Contains(fine + "3,") && Contains("{\"levels\":3,"));
  CHECK_THAT(plan(" --most-levels 2"), Catch::StartsWith(coarse) && Contains(fine + "2,") &&
                                           Contains("{\"levels\":2,") && !Contains("{\"levels\":3"));
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 2);
  drape_ends("sweep s.yaml --most-levels 2 --out out", folder);
  CHECK_THAT(text_of(folder / "out/runs/levels=3,step_growth=1.5/seed_1/config.yaml"),
             Contains("\nlevels: 2\n"));
}

TEST_CASE("runs of chosen methods keep the reference unless it is of another method") {
  const Scratch folder(small_experiment());
  folder.write("s.yaml",
               "name: s\nbase: e.yaml\nmethods: [cascadic]\nablation:\n"
               "  - name: its own\n    set: {reference: {method: cascadic, force_tolerance: 1e-4}}\n"
               "  - name: lowest\n    set: {reference: lowest}\n"
               "  - name: another\n    set: {reference: newton}\n");
  drape_ends("sweep s.yaml --out out", folder);
  std::string references;
  for (const std::string variation : {"its_own", "lowest", "another"}) {
    const auto json = json_in(folder / ("out/runs/" + variation + "/seed_1/results.json"));
    references += (json.contains("reference") ? json["reference"].value("method", "") : "none") + " ";
  }
  CHECK(references == "cascadic cascadic none ");
}

TEST_CASE("a setting may be a whole map or list, and its files are relative to the sweep's own") {
  const Scratch folder(small_experiment());
  fs::create_directories(folder / "sweeps/meshes");
  folder.write("sweeps/meshes/sheet.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
  folder.write("sweeps/s.yaml", R"(name: s
base: ../e.yaml
set: {levels: 2}
methods: [newton]
ablation:
  - {name: other energies, set: {energies: [stvk, {type: gravity, acceleration: [0, 0, -5]}],
      methods: {newton: {newton: {step_size: 0.25}}}, reference: newton}}
  - {name: mesh, set: {cloth: {shape: file, file: meshes/sheet.off}}}
)");
  drape_ends("sweep sweeps/s.yaml --out out", folder);
  const std::string other = text_of(folder / "out/runs/other_energies/seed_1/config.yaml");
  for (const char* line : {"- type: stvk\n", "acceleration: [0, 0, -5]\n", "step_size: 0.25\n"})
    CHECK_THAT(other, Catch::Contains(line) && !Catch::Contains("hinge"));
  CHECK(fs::exists(folder / "out/runs/mesh/seed_1/levels/newton_l1.ply"));
  const auto json = json_in(folder / "out/sweep.json");
  CHECK(json["complete"] == true);
  CHECK(json["runs"][0]["settings"]["energies"][1]["acceleration"][2] == -5);
  CHECK(json["runs"][1]["folder"] == "runs/mesh/seed_1");
}

TEST_CASE("a key that only other variations set has the run's own value") {
  const Scratch folder(small_experiment());
  folder.write("s.yaml",
               "name: s\nbase: e.yaml\nset: {material: {fabric: cotton}, newton.max_steps: 9}\nablation:\n"
               "  - {name: a}\n"
               "  - {name: b, set: {material.fabric: wool-lycra, methods.newton.newton.max_steps: 7}}\n");
  CHECK_THAT(shown_by("sweep s.yaml --dry-run", folder.path),
             Catch::Contains("{\"material.fabric\":\"cotton\",\"methods.newton.newton.max_steps\":9}"));
}
