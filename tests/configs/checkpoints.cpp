// Runs that are interrupted and go on end with the bits of one that was not.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <tuple>

#include "core/app/run/runner.h"
#include "core/app/run/saved_run.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/contact_scenes.h"
#include "tests/support/folders.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

/// Two small sheets, on three levels.
void write_sheets(const Scratch& folder) {
  write_sheets(folder, 6);
  folder.write("e.yaml", replaced(text_of(folder / "e.yaml"), "levels: 2", "levels: 3"));
}

/// Some steps a level, in which the sheets come to touch each other and the ball; with these settings.
Overrides some_steps(const Overrides& more) {
  Overrides all = {{"start.translate", "[-0.2, -0.2, 0.1015]"}, {"newton.max_steps", "8"}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Without what a clock or the machine says.
nlohmann::json timeless(nlohmann::json json) {
  if (json.is_object()) {
    for (const char* key : {"seconds", "seconds_by_phase", "peak_memory_bytes"}) json.erase(key);
    for (auto& item : json.items()) item.value() = timeless(item.value());
  }
  if (json.is_array())
    for (nlohmann::json& item : json) item = timeless(item);
  return json;
}

/// Rows without the column of that name.
std::string without_column(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::string kept;
  int column = -1;
  for (std::string line; std::getline(lines, line); kept += "\n") {
    const std::vector<std::string> cells = split(line, ',');
    for (int k = 0; k < int(cells.size()); ++k) {
      if (cells[k] == name && column < 0) column = k;
      if (k != column) kept += cells[k] + ",";
    }
  }
  return kept;
}

/// All that two equal runs have in common, by file.
std::map<std::string, std::string> outcome_of(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const char* part : {"levels", "snapshots", "fields", "obstacles"})
    if (fs::exists(folder / part))
      for (const auto& entry : fs::directory_iterator(folder / part))
        all[part + ("/" + entry.path().filename().string())] = text_of(entry.path());
  all["results.json"] = timeless(json_in(folder / "results.json")).dump(1);
  all["iterations.csv"] = without_column(text_of(folder / "iterations.csv"), "seconds");
  all["errors.csv"] = without_column(text_of(folder / "errors.csv"), "seconds");
  return all;
}

void check_equal(const fs::path& folder, const fs::path& expected) {
  const auto a = outcome_of(folder), b = outcome_of(expected);
  REQUIRE(a.size() == b.size());
  for (const auto& [name, bytes] : b) {
    INFO(name);
    REQUIRE(a.count(name) == 1);
    if (name.ends_with(".csv") || name.ends_with(".json"))
      CHECK(a.at(name) == bytes);
    else
      CHECK((a.at(name) == bytes));  // not shown
  }
}

RunOptions silent(const fs::path& out) {
  RunOptions options;
  options.out = out;
  options.verbosity = Verbosity::quiet;
  options.report = false;
  return options;
}

/// Runs an experiment in one go and again in as many parts as it can be cut into: every part is stopped the
/// second time that anything asks, which is after one step, or if that leads nowhere, later. How many parts;
/// `visit`, if it is given, sees the states within a level with which they began.
int check_in_parts(const Scratch& scratch, Overrides overrides,
                   const std::function<void(const NewtonState&)>& visit = {}) {
  // Every part measures the start again: at full resolution that takes longer than its steps.
  overrides.push_back(
      {"metrics",
       "[curvature_consistency, distance, residuals, {type: silhouette, resolution: 32}, stretch]"});
  const fs::path& folder = scratch.path;
  const Experiment experiment = experiment_in(folder / "e.yaml", overrides);
  run_experiment(experiment, *scene_of(experiment), silent(folder / "whole"));
  REQUIRE(json_in(folder / "whole/results.json")["complete"] == true);

  int parts = 1, patience = 2, asked = 0;
  RunOptions options = silent(folder / "parts");
  options.stop = [&] { return ++asked > patience; };
  run_experiment(experiment, *scene_of(experiment), options);
  for (std::string before; !is_complete(options.out); ++parts) {
    REQUIRE(parts < 2000);
    std::vector<std::string> warnings;
    InterruptedRun interrupted = interrupted_run(RunFolder::of_run(options.out), warnings);
    CHECK(warnings.empty());
    const Checkpoint& checkpoint = interrupted.checkpoint;
    const MethodState& state = checkpoint.state;
    const std::string now = std::to_string(checkpoint.method) + " " + std::to_string(state.level) + " " +
                            (state.under_way ? std::to_string(state.under_way->so_far.steps) : "begins");
    if (visit && state.under_way) visit(*state.under_way);
    patience = now == before ? 2 * patience : 2;
    before = now;
    asked = 0;
    const Experiment again = experiment_in(options.out / "config.yaml");
    resume_experiment(again, *scene_of(again), options, std::move(interrupted));
  }
  check_equal(folder / "parts", folder / "whole");
  return parts;
}

}  // namespace

TEST_CASE("A run that is stopped at every step and resumed equals an uninterrupted one, bit for bit") {
  const Scratch folder(small_experiment());
  const Overrides short_levels = {{"levels", "3"}, {"newton.max_steps", "8"}};
  CHECK(check_in_parts(folder, short_levels) > 60);
  const Scratch compared(small_experiment());
  const std::string reference = "{file: " + (folder / "whole/levels/pcs_l2.ply").string() + "}";
  CHECK(check_in_parts(compared, {{"levels", "3"}, {"newton.max_steps", "2"}, {"reference", reference}}) > 5);
}

TEST_CASE("So does one with self-contact, obstacles, friction and a strain limit, however Newton solves it") {
  // A stop is asked for within steps of two iterations too, and such a part leads nowhere: more steps.
  const std::tuple<std::string, Overrides, int> cases[] = {
      {"as it is", {}, 60},
      {"by multigrid", {{"newton.linear_solver", "multigrid"}}, 60},
      {"several iterations a step", {{"newton.iterations_per_step", "2"}, {"newton.max_steps", "12"}}, 60},
      {"static, with full projection",
       {{"newton.form", "static"}, {"newton.psd_blend", "full"}, {"levels", "2"}},
       20}};
  for (const auto& [name, settings, parts] : cases) {
    INFO(name);
    const Scratch folder;
    write_sheets(folder);
    CHECK(check_in_parts(folder, some_steps(settings)) > parts);
  }
}

TEST_CASE(
    "So does one of PCS whose levels relax, into a matrix of the same pattern, of another, with contact") {
  const std::string interpolation = "interpolation: {membrane: refiner, bending: refiner, external: refiner}";
  const Overrides small = {
      {"levels", "2"}, {"cloth.columns", "5"}, {"cloth.rows", "5"}, {"reference", "pcs"}};
  for (const auto& [name, pcs] : {std::pair(std::string("golden"), std::string()),
                                  {"golden", interpolation},
                                  {"contact", ""},
                                  {"contact", interpolation}}) {
    INFO(name << ": " << pcs);
    const Scratch folder(experiment_of_tests(name));
    Overrides overrides = small;
    overrides.push_back({"methods", "{pcs: {" + pcs + "}}"});
    overrides.push_back({"newton.force_tolerance", name == "golden" ? "1e-8" : "1e-4"});
    int relaxing = 0;
    CHECK(check_in_parts(folder, overrides,
                         [&](const NewtonState& state) { relaxing += state.switched_to_plain; }) > 15);
    CHECK(relaxing > 1);
  }
}

TEST_CASE("So does one whose contact stiffness is raised") {
  const Scratch folder(drum("7", "2", "5", "pcs"));
  CHECK(check_in_parts(folder, {}) > 20);
  const nlohmann::json levels = json_in(folder / "whole/results.json")["methods"]["pcs"]["levels"];
  const auto stiffness = [&](int level) {
    return levels[level]["contact_stiffness"].get<std::vector<double>>();
  };
  const double own = 10 * 9.81 * 5 * 3e-4;
  // That of the model whose ball carries, on both levels, and the next level begins with it.
  CHECK(stiffness(0)[0] == Approx(own));
  CHECK(stiffness(1)[0] == Approx(own));
  CHECK(stiffness(0)[1] == Approx(4 * own));
  CHECK(stiffness(1)[1] == Approx(16 * own));
}

TEST_CASE("So does one under load stepping, with pins that are stopped on their way and moving obstacles") {
  // The ball rises into the sheets, which are held at two corners and become softer. One corner is pulled
  // farther up at once than the strain limit lets it.
  const std::string schedule = R"(
pins:
  - {region: vertices, vertices: [0], translate: [-0.2, -0.2, 0.1015]}
  - {region: vertices, vertices: [35], translate: [-0.2, -0.2, 0.1015]}
schedule:
  steps: 6
  keys:
    - {parameter: material.bending_modulus, times: [0, 0.5], values: [8e4, 8e3], interpolation: log}
    - {parameter: obstacles.0.translate, times: [0, 1], values: [[0, 0, 0], [0, 0, 0.03]]}
    - parameter: pins.1.translate
      times: [0, 0.5, 1]
      values: [[-0.2, -0.2, 0.1015], [-0.2, -0.2, 0.3], [-0.2, -0.2, 0.1015]]
    - {parameter: energies.strain_limit.limit, times: [0, 1], values: [1.06, 1.04]}
)";
  int held = 0;
  for (const char* equilibrate : {"false", "true"}) {
    const Scratch folder;
    write_sheets(folder);
    folder.write("e.yaml", text_of(folder / "e.yaml") + schedule);
    const Overrides some = some_steps({{"schedule.equilibrate", equilibrate},
                                       {"newton.force_tolerance", "0.1"},
                                       {"newton.max_steps", "20"},
                                       {"levels", "2"}});
    CHECK(check_in_parts(folder, some, [&](const NewtonState& state) {
            held += !state.dirichlet.unsatisfied.empty() && !state.dirichlet.released;
          }) > 40);
  }
  CHECK(held > 5);
}

TEST_CASE("So does one whose cloth is advected by an obstacle") {
  const Scratch folder(R"(name: lifted
cloth: {shape: square, side: 0.4, columns: 8, rows: 8}
levels: 1
start: {translate: [-0.2, -0.2, 0.11], perturbation: 1e-3}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{name: ball, shape: sphere, radius: 0.1}]
friction: 0.3
schedule: {steps: 2, equilibrate: true, keys: [{parameter: obstacles.0.translate, times: [0, 1], values: [[0, 0, 0], [0, 0, 0.05]]}]}
newton: {force_tolerance: 1e-2}
methods: {pcs: {}}
)");
  const int parts = check_in_parts(folder, {});
  CHECK(parts > 40);
  CHECK(parts < 300);  // by a tenth of a millimetre at a time there would be a thousand
}

TEST_CASE("So does one of PCS whose schedule leaves a pin with a single vertex") {
  const Scratch folder(R"(name: clip
cloth: {shape: square, side: 0.4, columns: 5, rows: 5}
levels: 2
start: {perturbation: 1e-3}
pins: [{region: ball, point: [0, 0, 0], radius: 0.11}]
energies: [neo_hookean, hinge, gravity]
schedule: {steps: 2, equilibrate: true, keys: [{parameter: pins.0.radius, times: [0, 1], values: [0.11, 0.001]}]}
newton: {force_tolerance: 0.1, max_steps: 30}
methods: {pcs: {}}
)");
  CHECK(check_in_parts(folder, {}) > 20);
}

TEST_CASE("The obstacles of a stopped run are where its schedule has come to, and resuming moves them on") {
  const Scratch folder(R"(name: raised
cloth: {shape: square, side: 0.4, columns: 3, rows: 3}
levels: 1
pins: [{region: ball, point: [0, 0, 0], radius: 0.01}]
energies: [neo_hookean, hinge, gravity]
contact: shapes
obstacles: [{shape: sphere, radius: 0.1}]
newton: {force_tolerance: 1e-2, max_steps: 20}
schedule: {steps: 8, keys: [
  {parameter: obstacles.0.translate, times: [0, 1], values: [[2, 0, 0], [2, 0, 0.8]]}]}
methods: {pcs: {}, newton: {}}
)");
  const fs::path out = folder / "out", ball = out / "obstacles/0.ply";
  const auto height = [&] { return read_mesh(ball).vertices.col(2).mean(); };
  const Experiment experiment = experiment_in(folder / "e.yaml");
  RunOptions options = silent(out);
  int asked = 0;
  options.stop = [&] { return ++asked > 4; };
  run_experiment(experiment, *scene_of(experiment), options);
  CHECK(height() > 0.09);
  CHECK(height() < 0.75);
  const auto resume = [&] {
    std::vector<std::string> warnings;
    resume_experiment(experiment, *scene_of(experiment), options,
                      interrupted_run(RunFolder::of_run(out), warnings));
  };
  const auto restored = [&] { return text_of(out / "log.jsonl").find("file_restored") != std::string::npos; };
  asked = 0;
  options.stop = [&] { return json_in(out / "results.json")["methods"].contains("newton") && ++asked > 3; };
  resume();  // pcs to its end, then newton's first steps
  CHECK(height() == Approx(0.8));
  CHECK_FALSE(restored());
  fs::remove(ball);
  resume();
  CHECK(height() == Approx(0.8));
  CHECK(restored());
}

TEST_CASE("So does one under load stepping with a level that begins at the scene's start") {
  // A big fan of needles over a row of tiny triangles: Loop's rest shape of the fan is centimetres away from
  // the coarse one, and the state of the coarse level does not get into it within the strain limit.
  constexpr int columns = 80;
  TriangleMesh fan = mesh_of({{0.5, 1, 0}}, {});
  for (const double y : {0., -0.002})
    for (int i = 0; i <= columns; ++i) append(fan, {{static_cast<double>(i) / columns, y, 0}}, {});
  for (int i = 0; i < columns; ++i) {
    const int a = 1 + i, c = columns + 2 + i;
    append(fan, {}, {{0, a, a + 1}, {a, c, a + 1}, {a + 1, c, c + 1}});
  }
  const Scratch folder;
  write_mesh(folder / "fan.obj", fan);
  folder.write("e.yaml",
               replaced(text_of(folders::source() / "configs/hard/drape.yaml"),
                        "{shape: square, side: 1, columns: 16, rows: 16}", "{shape: file, file: fan.obj}") +
                   R"(
schedule: {steps: 3, keys: [{parameter: energies.gravity.acceleration, times: [0, 1], values: [[0, 0, -9.81], [1, 0, -9.81]]}]}
)");
  const Overrides stuck = {{"start.translate", "[-0.5, -0.3, 0.32]"},
                           {"start.perturbation", "1e-6"},
                           {"methods", "{cascadic: {}}"},
                           {"snapshots", "2"},
                           {"newton.max_steps", "60"}};
  CHECK(check_in_parts(folder, stuck) > 15);
  const nlohmann::json levels = json_in(folder / "parts/results.json")["methods"]["cascadic"]["levels"];
  REQUIRE(levels.size() == 2);
  CHECK_THAT(levels[1]["message"].get<std::string>(),
             Contains("the level starts from the scene's start instead"));
}

namespace {

/// A run of the sheets in its folder `out`, with a checkpoint at every step.
const std::string sheets_run =
    "run e.yaml --out out --method all --quiet --no-report --threads 1 --checkpoint 0 --set "
    "newton.max_steps=8 --set start.translate=[-0.2,-0.2,0.1015]";
const std::string go_on = "run --resume out --quiet --no-report --threads 1 --checkpoint 0";

/// Waits until the run has taken that many steps.
void wait_for_steps(Command& command, const fs::path& out, int steps) {
  wait_for_lines(command, out / "iterations.csv", steps + 1);
}

/// What a run of the sheets leaves that was interrupted in the middle.
void interrupt_sheets(const Scratch& folder) {
  write_sheets(folder);
  DrapeAtWork command(sheets_run, folder);
  wait_for_steps(command, folder / "out", 12);
  REQUIRE(command.ended_by(SIGINT).exit_code == 130);
  REQUIRE_FALSE(is_complete(folder / "out"));
}

}  // namespace

TEST_CASE("A run that is killed at random moments resumes every time, with equal results") {
  const Scratch folder;
  write_sheets(folder);
  DrapeAtWork check("check e.yaml", folder);
  REQUIRE(check.wait().exit_code == 0);
  const double to_begin = check.processor_time();
  drape_ends(replaced(sheets_run, "--out out", "--out whole"), folder, 1);
  const long all_steps = lines_in(folder / "whole/iterations.csv");

  std::mt19937 random(5);
  int kills = 0, cut = 0;
  for (int resumed = 0; resumed < 15; ++kills) {
    REQUIRE(kills < 60);  // on a busy machine more of them come before the first state
    const bool begun = fs::exists(folder / "out/checkpoint/state.bin");
    resumed += begun;
    DrapeAtWork command((begun ? go_on : sheets_run + " --overwrite"), folder);
    // Half of them while it begins, half after some steps more than it had, at most a twentieth of all.
    const double part = static_cast<double>(random() % 1000) / 1000;
    if (kills % 2)
      command.wait_until("a part of its beginning",
                         [&] { return command.processor_time() > part * to_begin; });
    else
      wait_for_steps(command, folder / "out",
                     static_cast<int>(lines_in(folder / "out/iterations.csv") + part * all_steps / 20));
    cut += command.ended_by(SIGKILL).exit_code == 128 + SIGKILL;
  }
  CHECK(cut == kills);
  CHECK_FALSE(is_complete(folder / "out"));
  CHECK(drape_ends(go_on, folder, 1).err == "");  // out of steps, as the run that was not killed
  check_equal(folder / "out", folder / "whole");
  CHECK(drape_ends("run --resume out", folder, 1).out ==  // the run's own exit code
        "out: the run is complete; there is nothing to resume\n");
  CHECK_FALSE(fs::exists(folder / "out/checkpoint/state.bin"));
}

TEST_CASE("Checkpoints that cannot be resumed are refused with the reason") {
  const Scratch folder;
  interrupt_sheets(folder);
  const std::string before = text_of(folder / "out/results.json");

  CHECK(refused_by("run --resume nowhere", folder.path) ==
        "error: nowhere: holds no run; give the results folder of one\n");
  const std::pair<std::string, std::string> options[] = {
      {"e.yaml --resume out", "takes the experiment from the run's own config.yaml; leave out e.yaml"},
      {"--resume out --overwrite", "leave out --overwrite"},
      {"--resume out --out other", "leave out --out"},
      {"--resume out --set newton.step_size=1", "is another run; name its folder with --out"},
      {"--resume out --set newton.step_size=1 --out ./out", "leaves the run that it begins from as it is"},
      {"e.yaml --level 1", "name its run with --resume"}};
  for (const auto& [arguments, expected] : options)
    CHECK_THAT(refused_by("run " + arguments, folder.path), Contains(expected));

  const auto damaged = [&](const std::string& name, const std::string& text, const std::string& expected) {
    const std::string whole = text_of(folder / name);
    folder.write(name, text);
    CHECK_THAT(refused_by("run --resume out", folder.path), Contains(expected));
    folder.write(name, whole);
  };
  damaged("out/config.yaml", text_of(folder / "out/config.yaml") + "# \n",
          "out/config.yaml: is not the one that the checkpoint was made with");
  damaged("out/rest/l0.ply", "ply\n", "out/rest/l0.ply: is not what it was when the run began");
  damaged("out/iterations.csv", "method\n",
          "out/iterations.csv: is shorter than when the checkpoint was made");
  for (const std::string name : {"out/iterations.csv", "out/log.jsonl"}) {
    const std::string whole = text_of(folder / name);
    fs::remove(folder / name);
    CHECK_THAT(refused_by("run --resume out", folder.path),
               Contains(name + ": is missing, and the run cannot be resumed without: put it back, or run the "
                               "experiment again"));
    folder.write(name, whole);
  }
  CHECK(text_of(folder / "out/results.json") == before);

  FileLock other(folder / "out/checkpoint/lock");
  REQUIRE(other.acquire(0));
  const std::string in_use = "uses this folder; wait for it, or stop it";
  CHECK_THAT(refused_by("run --resume out", folder.path), Contains(in_use));
  // Before the checkpoint is read, which the other process goes on to replace.
  damaged("out/config.yaml", "name: other\n", in_use);
  damaged("out/results.json", "{\"complete\": true}", in_use);
}

TEST_CASE("A damaged checkpoint is replaced by its predecessor, with a warning") {
  const Scratch folder;
  interrupt_sheets(folder);
  drape_ends(replaced(sheets_run, "--out out", "--out whole"), folder, 1);
  folder.write("out/checkpoint/state.bin", "drapestt");
  CHECK_THAT(drape_ends(go_on, folder, 1).err, Contains("state.bin: is cut short; going on from "));
  check_equal(folder / "out", folder / "whole");
}

TEST_CASE("Damaged and missing files of an interrupted run are restored, bit for bit") {
  const Scratch folder(small_experiment());
  const Experiment experiment =
      experiment_in(folder / "e.yaml", {{"newton.max_steps", "6"}, {"levels", "3"}});
  run_experiment(experiment, *scene_of(experiment), silent(folder / "whole"));
  RunOptions options = silent(folder / "out");
  // In the third method, so that the first two are known by the checkpoint alone.
  options.stop = [&] { return fs::exists(folder / "out/levels/newton_l0.ply"); };
  run_experiment(experiment, *scene_of(experiment), options);
  REQUIRE_FALSE(is_complete(folder / "out"));
  std::map<std::string, std::string> before;
  for (const char* part : {"levels", "rest", "fields"})
    for (const auto& entry : fs::directory_iterator(folder / "out" / part))
      before[part + ("/" + entry.path().filename().string())] = text_of(entry.path());
  // The level that was stopped is no result yet.
  for (const char* stopped : {"newton_l1.ply", "newton_l1.vtp", "newton.pvd"})
    REQUIRE(before.erase(std::string("levels/") + stopped) == 1);
  for (const char* stopped : {"fields/newton_l0_l2.ply", "fields/newton_l1_l2.ply"})
    REQUIRE(before.count(stopped) == 0);
  REQUIRE(before.size() == 3 + 2 * 7 + 2 + 2 * 2);

  const auto write = [&](const std::string& name, const std::string& bytes) {
    folder.write("out/" + name, bytes);
  };
  folder.damage("out/levels/pcs_l0.ply");
  write("levels/pcs_l2.ply", before.at("levels/pcs_l2.ply").substr(0, 100));
  write("levels/cascadic_l1.vtp", "");
  fs::remove(folder / "out/levels/cascadic_l1.ply");
  fs::remove(folder / "out/levels/newton_l0.ply");
  fs::remove(folder / "out/levels/pcs.pvd");
  fs::remove_all(folder / "out/rest");
  fs::remove(folder / "out/fields/pcs_l0_l2.ply");
  std::string flipped = before.at("fields/cascadic_l1_l2.ply");
  flipped[flipped.size() - 9] ^= 1;
  write("fields/cascadic_l1_l2.ply", flipped);

  CHECK(drape_ends("run --resume out --quiet --no-report", folder, 1).err ==  // out of steps
        "warning: damaged or missing files were written again: rest/l0.ply, rest/l1.ply, rest/l2.ply, "
        "levels/pcs_l0.ply, levels/pcs_l2.ply, levels/cascadic_l1.ply, levels/cascadic_l1.vtp, "
        "levels/newton_l0.ply, levels/pcs.pvd, fields/pcs_l0_l2.ply, fields/cascadic_l1_l2.ply\n");
  for (const auto& [name, bytes] : before) {
    INFO(name);
    CHECK((text_of(folder / ("out/" + name)) == bytes));
  }
  check_equal(folder / "out", folder / "whole");
}

TEST_CASE("Damaged snapshots are skipped in errors.csv, without other effects") {
  const Scratch folder(small_experiment());
  const Experiment experiment = experiment_in(folder / "e.yaml");
  RunOptions options = silent(folder / "out");
  options.stop = [&] { return fs::exists(folder / "out/levels/cascadic_l0.ply"); };
  run_experiment(experiment, *scene_of(experiment), options);
  folder.damage("out/snapshots/pcs_l0.bin");
  drape_ends("run --resume out --quiet --no-report", folder);
  CHECK_THAT(text_of(folder / "out/log.jsonl"), Contains("snapshots/pcs_l0.bin: is damaged"));
  const std::string errors = text_of(folder / "out/errors.csv");
  CHECK(errors.find("\npcs,0,") == std::string::npos);
  CHECK(errors.find("\npcs,1,") != std::string::npos);
}

TEST_CASE("Resuming a complete run returns its exit code and checks its files") {
  const Scratch folder(small_experiment());
  const std::string run = "run e.yaml --quiet --no-report --method pcs --out ",
                    said = ": the run is complete; there is nothing to resume\n";
  drape_ends(run + "good", folder);
  drape_ends(run + "poor --set newton.max_steps=2", folder, 1);
  CHECK(shown_by("run --resume good", folder.path) == "good" + said);
  CHECK(drape_ends("run --resume poor", folder, 1).out == "poor" + said);

  const std::string rest = text_of(folder / "good/rest/l1.ply");
  fs::remove_all(folder / "good/rest");
  CHECK(drape_ends("run --resume good", folder).err ==
        "warning: damaged or missing files were written again: rest/l0.ply, rest/l1.ply\n");
  CHECK((text_of(folder / "good/rest/l1.ply") == rest));

  folder.damage("good/levels/pcs_l0.ply");
  fs::remove(folder / "good/levels/pcs_l1.ply");
  CHECK(refused_by("run --resume good", folder.path) ==
        "error: good: the run is complete, but files are damaged or missing: levels/pcs_l0.ply, "
        "levels/pcs_l1.ply; run the experiment again, as in drape run good/config.yaml --out ANOTHER\n");
  CHECK_THAT(refused_by("run --resume good --level 0 --out x", folder.path),
             Contains("damaged or missing: levels/pcs_l0.ply"));
}

TEST_CASE("results.json tells on how many threads a run was resumed") {
  const Scratch folder;
  interrupt_sheets(folder);
  drape_ends(replaced(go_on, "--threads 1", "--threads 2"), folder, 1);
  const nlohmann::json all = json_in(folder / "out/results.json");
  CHECK(all["machine"]["threads"] == 1);
  REQUIRE(all["resumed"].size() == 1);
  CHECK(all["resumed"][0]["machine"]["threads"] == 2);
}

TEST_CASE("A changed rest shape of a cloth's file replaces no finer one") {
  const Scratch folder;
  write_sheets(folder);
  drape_ends("run e.yaml --out out --quiet --no-report --method newton --levels 2 --set newton.max_steps=2",
             folder, 1);
  TriangleMesh rest = read_mesh(folder / "out/rest/l0.ply");
  rest.vertices(0, 2) += 1e-3;
  write_mesh(folder / "out/rest/l0.ply", rest);
  const std::string finer = text_of(folder / "out/rest/l1.ply");
  CHECK_THAT(refused_by("run --resume out", folder.path), Contains("does not follow from rest/l0.ply"));
  CHECK((text_of(folder / "out/rest/l1.ply") == finer));
}

TEST_CASE("A description that is a folder's name is no input") {
  const Scratch folder(small_experiment());
  const Overrides named = {{"description", folder.path.string()}};
  CHECK(files_of(saved_config(experiment_in(folder / "e.yaml", named))).empty());
}

TEST_CASE("A checkpoint whose values do not fit its experiment is refused before the first write") {
  const Scratch folder;
  interrupt_sheets(folder);
  const Experiment experiment = experiment_in(folder / "out/config.yaml");
  const auto scene = scene_of(experiment);
  std::vector<std::string> warnings;
  const auto interrupted = [&] { return interrupted_run(RunFolder::of_run(folder / "out"), warnings); };
  const Checkpoint sound = interrupted().checkpoint;
  REQUIRE(sound.state.under_way);
  REQUIRE_NOTHROW(require_fitting(sound, experiment, *scene));
  const auto refused = [&](const std::string& what, const std::function<void(Checkpoint&)>& change) {
    InterruptedRun other = interrupted();
    change(other.checkpoint);
    INFO(what);
    CHECK_THROWS_WITH(resume_experiment(experiment, *scene, silent(folder / "out"), std::move(other)),
                      Contains("the checkpoint does not fit its experiment: " + what));
  };
  const std::string before = text_of(folder / "out/log.jsonl");
  const auto under_way = [](Checkpoint& c) -> NewtonState& { return *c.state.under_way; };
  refused("the method under way", [](auto& c) { c.method = 3; });
  refused("the method under way", [](auto& c) { c.method = -1; });
  refused("the experiment has no method", [](auto& c) { c.methods[0] = "x"; });
  refused("the level that the methods begin with", [](auto& c) { c.first_level = -1; });
  refused("the level under way", [](auto& c) { c.state.level = 1 << 30; });
  refused("the lag of friction", [&](auto& c) { under_way(c).contacts.damping = {0.5, {}}; });
  refused("the lag of friction", [&](auto& c) { under_way(c).contacts.damping.fraction = std::nan(""); });
  refused("the lag of friction", [&](auto& c) { under_way(c).contacts.damping.lag.resize(7); });
  refused("the lag of friction", [&](auto& c) {
    FrictionContact contact{};
    contact.vertices = {1 << 20, -1, -1, -1};
    under_way(c).contacts.damping.lag.assign(under_way(c).contacts.stiffness.size(), {{contact}});
  });
  refused("the level under way", [&](auto& c) { under_way(c).so_far.level += 1; });
  refused("the level before the one under way", [](auto& c) {
    c.state.finished.pop_back();
    c.state.finished.push_back({});
    c.state.finished.back().level = c.state.level;
    c.state.finished.back().x = c.state.under_way->so_far.x;
  });
  refused("the state of level", [&](auto& c) { under_way(c).so_far.x.conservativeResize(3, 3); });
  refused("the state of level", [&](auto& c) { under_way(c).so_far.x(1, 1) = std::nan(""); });
  refused("negative counts", [&](auto& c) { under_way(c).so_far.steps = -1; });
  refused("a Dirichlet vertex out of range",
          [&](auto& c) { under_way(c).dirichlet.unsatisfied = {1 << 20}; });
  refused("the settings of the step",
          [&](auto& c) { under_way(c).step.controller.step_size = std::nan(""); });
  refused("the settings of the step", [&](auto& c) { under_way(c).step.factor.blend = -1; });
  refused("the settings of the step", [&](auto& c) { under_way(c).step.factor.blend = 7; });
  refused("the response to an increment",
          [&](auto& c) { under_way(c).load_stepper.response.predicted = Positions::Zero(1, 3); });
  refused("the contacts: ", [&](auto& c) { under_way(c).contacts.reference.resize(0, 3); });
  refused("the contacts' tangential displacements",
          [&](auto& c) { under_way(c).contacts.tangential_displacements.clear(); });
  refused("the contacts' stiffness", [&](auto& c) { under_way(c).contacts.stiffness.clear(); });
  refused("the contacts' stiffness", [&](auto& c) { under_way(c).contacts.stiffness.at(0) = -1; });
  refused("the contacts' stiffness", [&](auto& c) { under_way(c).so_far.contact_stiffness = {1, 1, 1}; });
  refused("the matrix's pattern", [&](auto& c) {
    under_way(c).step.factor.pattern.extra = {{{0, 1 << 20}}, {0}};
  });
  refused("the matrix's pattern", [&](auto& c) { under_way(c).step.factor.pattern.extra = {{{0, 1}}, {}}; });
  refused("the factor's ordering", [&](auto& c) { under_way(c).step.factor.analysis.ordering.at(0) = -1; });
  refused("the factor's ordering", [&](auto& c) { under_way(c).step.factor.analysis.fixed.pop_back(); });
  refused("results.json as it was", [](auto& c) { c.recorder.results = "{"; });
  refused("results.json as it was, of the method under way", [](auto& c) { c.recorder.method = "x"; });
  refused("a level's result", [](auto& c) { c.recorder.states = {{"pcs", 7, Positions()}}; });
  refused("the snapshots", [](auto& c) { c.recorder.snapshots.spacing = 0; });
  refused("the snapshots", [](auto& c) { c.recorder.states.at(0).snapshots = {}; });
  CHECK(text_of(folder / "out/log.jsonl") == before);
}

TEST_CASE("A run whose schedule selects ever more pinned vertices resumes while they are blocked") {
  const Scratch folder(R"yaml(name: g
cloth: {shape: square, side: 0.4, vertices: 100}
levels: 1
start: {translate: [-0.2, -0.2, 0.12], perturbation: 1e-3}
pins: [{region: ball, point: [0.2, 0.2, 0], radius: 0.05, translate: [-0.2, -0.2, 0.12]}]
obstacles: [{name: ball, shape: sphere, radius: 0.1}]
energies: [neo_hookean, hinge, gravity]
contact: [shapes]
friction: 0.3
schedule:
  steps: 4
  equilibrate: true
  keys:
    - {parameter: pins.0.translate, times: [0, 1], values: [[-0.2, -0.2, 0.12], [-0.2, -0.2, 0.05]]}
    - {parameter: pins.0.radius, times: [0, 1], values: [0.05, 0.12]}
methods: {newton: {}}
)yaml");
  DrapeAtWork command("run e.yaml --out out --checkpoint 0 -q --no-report", folder);
  wait_for_steps(command, folder / "out", 320);
  REQUIRE(command.ended_by(SIGINT).exit_code == 130);
  const Ended resumed = drape_with("run --resume out -q --no-report", folder.path);
  CHECK(resumed.exit_code != 2);
  CHECK(is_complete(folder / "out"));
}

TEST_CASE("An obstacle's mesh that changed since is named") {
  const Scratch folder(replaced(experiment_of_tests("contact"), "obstacles: [",
                                "obstacles: [{mesh: box.obj, translate: [0, 0, -1]}, "));
  write_mesh(folder / "box.obj", grid({0.4, 0.4}, 2, 2, Diagonals::one_way));
  DrapeAtWork command(sheets_run, folder);
  wait_for_steps(command, folder / "out", 3);
  command.ended_by(SIGKILL);
  write_mesh(folder / "box.obj", grid({0.5, 0.4}, 2, 2, Diagonals::one_way));
  CHECK_THAT(refused_by("run --resume out", folder.path),
             Contains("box.obj: is not what it was when the run began"));
  fs::remove(folder / "box.obj");
  CHECK_THAT(refused_by("run --resume out", folder.path), Contains("box.obj"));
}

TEST_CASE("A run warm-starts from a saved state under changed parameters, in another folder") {
  const Scratch folder;
  interrupt_sheets(folder);
  const std::string flow = "run --resume out --quiet --no-report --threads 1 --set newton.max_steps=4 ";
  const auto rows = [&](const std::string& out) {
    const std::string text = text_of(folder / (out + "/iterations.csv"));
    return text.substr(text.find('\n') + 1);
  };

  drape_ends(flow + "--out last", folder, 1);
  CHECK(rows("last").starts_with("pcs,1,0,0,"));  // the level under way after 12 steps of 8 a level
  const nlohmann::json last = json_in(folder / "last/results.json");
  CHECK(last["warm_started_from"] == "out, method pcs, level 1");
  REQUIRE(last["methods"].size() == 1);
  REQUIRE(last["methods"]["pcs"]["levels"].size() == 2);
  CHECK(last["methods"]["pcs"]["levels"][0]["from_initial_state"] == true);

  drape_ends(flow + "--out soft --level 0 --set material.bending_modulus=1e3", folder, 1);
  CHECK(rows("soft").starts_with("pcs,0,0,0,"));

  // It begins where the other run left the level: inertia holds the cloth there.
  const std::string hold = " --set newton.step_size=1e-7 --set newton.step_growth=1";
  drape_ends(flow + "--out held --level 0" + hold, folder, 1);
  drape_ends(replaced(sheets_run, "--out out", "--out start") + hold + " --set newton.max_steps=1", folder,
             1);
  const auto state = [&](const std::string& out) {
    return read_mesh(folder / (out + "/levels/pcs_l0.ply")).vertices;
  };
  CHECK((state("held") - state("out")).norm() < 1e-6);
  CHECK((state("start") - state("out")).norm() > 1e-3);

  // Interrupted and resumed, it has the bits of one that is not.
  DrapeAtWork command(flow + "--out part --checkpoint 0", folder);
  wait_for_steps(command, folder / "part", 5);
  command.ended_by(SIGKILL);
  drape_with(replaced(go_on, "--resume out", "--resume part"), folder.path);
  check_equal(folder / "part", folder / "last");

  const std::pair<std::string, std::string> refusals[] = {
      {"--set refiner=midpoint", "--set refiner: \"refiner\" cannot be changed"},
      {"--set cloth.grain=9", "\"cloth\" cannot be changed"},
      {"--levels 1", "\"levels\" must be at least 2"},
      {"--level 2", "holds no state of method pcs on level 2; the last level that it has is 1"},
      {"--method cascadic", "holds no state of method cascadic; name another with --method"},
      {"--set obstacles.ball.radius=0.15", "the start of level 1 touches: "}};
  for (const auto& [change, expected] : refusals)
    CHECK_THAT(refused_by(flow + "--out x " + change, folder.path), Contains(expected));
  CHECK_FALSE(fs::exists(folder / "x"));
}
