// Runs that are killed, or whose files are damaged, and go on; and runs that begin from another run's state.

#include <random>

#include "core/numerics/mesh_files/io.h"
#include "tests/configs/resuming.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Runs an experiment into the folder `out`, until it has written this file.
void run_until(const std::string& file, const Scratch& folder, const Experiment& experiment) {
  RunOptions options = silent(folder / "out");
  options.stop = [&] { return fs::exists(folder / ("out/" + file)); };
  run_experiment(experiment, *scene_of(experiment), options);
  REQUIRE_FALSE(is_complete(folder / "out"));
}

}  // namespace

TEST_CASE("A run that is killed at random moments resumes every time, with equal results") {
  const Scratch folder;
  write_sheets(folder);
  DrapeAtWork check("check e.yaml", folder);
  REQUIRE(check.wait().exit_code == 0);
  const double to_begin = check.processor_time();
  drape_ends(sheets_run("whole"), folder, 1);
  const long all_steps = lines_in(folder / "whole/iterations.csv");

  std::mt19937 random(5);
  int kills = 0, cut = 0;
  for (int resumed = 0; resumed < 15; ++kills) {
    REQUIRE(kills < 60);  // on a busy machine more of them come before the first state
    const bool begun = fs::exists(folder / "out/checkpoint/state.bin");
    resumed += begun;
    DrapeAtWork command(begun ? go_on : sheets_run("out --overwrite"), folder);
    // Half of them while it begins, half after some steps more than it had, at most a twentieth of all.
    const double part = static_cast<double>(random() % 1000) / 1000;
    if (kills % 2)
      command.wait_until("it has begun", [&] { return command.processor_time() > part * to_begin; });
    else
      wait_for_steps(command, folder / "out",
                     static_cast<int>(lines_in(folder / "out/iterations.csv") + part * all_steps / 20));
    cut += command.ended_by(SIGKILL).exit_code == 128 + SIGKILL;
  }
  CHECK(cut == kills);
  CHECK_FALSE(is_complete(folder / "out"));
  CHECK_THAT(drape_ends(go_on, folder, 1).err,  // out of steps, as the run that was not killed
             Catch::Matches(shortfalls));
  check_equal(folder / "out", folder / "whole");
  CHECK_FALSE(fs::exists(folder / "out/checkpoint/state.bin"));
}

TEST_CASE("A damaged checkpoint is replaced by its predecessor, with a warning") {
  const Scratch folder;
  interrupt_sheets(folder);
  drape_ends(sheets_run("whole"), folder, 1);
  folder.write("out/checkpoint/state.bin", "drapestt");
  CHECK_THAT(drape_ends(go_on, folder, 1).err, Contains("state.bin: is cut short; going on from "));
  check_equal(folder / "out", folder / "whole");
}

TEST_CASE("Damaged and missing files of an interrupted run are restored, bit for bit") {
  const Scratch folder(small_experiment());
  const Experiment experiment =
      experiment_in(folder / "e.yaml", {{"newton.max_steps", "6"}, {"levels", "3"}});
  run_experiment(experiment, *scene_of(experiment), silent(folder / "whole"));
  run_until("levels/newton_l0.ply", folder,
            experiment);  // so the first two methods are known by the checkpoint alone
  auto before = files_in(folder / "out");
  std::erase_if(before, [](const auto& file) {
    return !file.first.starts_with("levels/") && !file.first.starts_with("rest/") &&
           !file.first.starts_with("fields/");
  });
  // The level that was stopped is no result yet.
  for (const char* stopped : {"levels/newton_l1.ply", "levels/newton_l1.vtp", "levels/newton.pvd"})
    REQUIRE(before.erase(stopped) == 1);
  for (const char* stopped : {"fields/newton_l0_l2.ply", "fields/newton_l1_l2.ply"})
    REQUIRE(before.count(stopped) == 0);
  REQUIRE(before.size() == 3 + 2 * 7 + 2 + 2 * 2);

  for (const char* name : {"levels/pcs_l0.ply", "fields/cascadic_l1_l2.ply"})
    folder.damage(std::string("out/") + name);
  folder.write("out/levels/pcs_l2.ply", before.at("levels/pcs_l2.ply").substr(0, 100));
  folder.write("out/levels/cascadic_l1.vtp", "");
  for (const char* name :
       {"levels/cascadic_l1.ply", "levels/newton_l0.ply", "levels/pcs.pvd", "rest", "fields/pcs_l0_l2.ply"})
    fs::remove_all(folder / "out" / name);
  CHECK_THAT(
      drape_ends("run --resume out --quiet --no-report --measure", folder, 1).err,  // out of steps
      Catch::Matches(
          "warning: damaged or missing files were written again: rest/l0.ply, rest/l1.ply, rest/l2.ply, "
          "levels/pcs_l0.ply, levels/pcs_l2.ply, levels/cascadic_l1.ply, levels/cascadic_l1.vtp, "
          "levels/newton_l0.ply, levels/pcs.pvd, fields/pcs_l0_l2.ply, fields/cascadic_l1_l2.ply\n" +
          shortfalls));
  for (const auto& [name, bytes] : before) {
    INFO(name);
    CHECK((text_of(folder / ("out/" + name)) == bytes));
  }
  check_equal(folder / "out", folder / "whole");
}

TEST_CASE("Damaged snapshots are skipped in errors.csv, without other effects") {
  const Scratch folder(small_experiment());
  run_until("levels/cascadic_l0.ply", folder, experiment_in(folder / "e.yaml"));
  folder.damage("out/snapshots/pcs_l0.bin");
  drape_ends("run --resume out --quiet --no-report --measure", folder);
  CHECK_THAT(text_of(folder / "out/log.jsonl"), Contains("snapshots/pcs_l0.bin: is damaged"));
  CHECK_THAT(text_of(folder / "out/errors.csv"), !Contains("\npcs,0,") && Contains("\npcs,1,"));
}

TEST_CASE("Resuming a complete run returns its exit code and checks its files") {
  const Scratch folder(small_experiment());
  const std::string said = ": the run is complete; there is nothing to resume\n";
  run_into("good", folder, "--method pcs");
  run_into("poor", folder, "--method pcs --set newton.max_steps=2", 1);
  CHECK(shown_by("run --resume good", folder.path) == "good" + said);
  CHECK(drape_ends("run --resume poor", folder, 1).out == "poor" + said);

  const std::string rest = text_of(folder / "good/rest/l1.ply");
  fs::remove_all(folder / "good/rest");
  CHECK(drape_ends("run --resume good", folder).err ==
        "warning: damaged or missing files were written again: rest/l0.ply, rest/l1.ply\n");
  CHECK((text_of(folder / "good/rest/l1.ply") == rest));

  folder.damage("good/levels/pcs_l0.ply");
  fs::remove(folder / "good/levels/pcs_l1.ply");
  CHECK(refused(folder, "run --resume good") ==
        "error: good: the run is complete, but files are damaged or missing: levels/pcs_l0.ply, "
        "levels/pcs_l1.ply; run the experiment again, as in drape run good/config.yaml --out ANOTHER\n");
  CHECK_THAT(refused(folder, "run --resume good --level 0 --out x"), Contains("missing: levels/pcs_l0.ply"));
}

TEST_CASE("Only keys that name files are inputs, whatever the values of others are") {
  const Scratch folder(R"({name: start.ply, description: /tmp, cloth: {vertices: 9}, levels: 1,
 energies: [neo_hookean, gravity], methods: {newton: {}, rest: {type: newton}},
 start: {translate: [0, 0, 1]}, contact: [shapes, ipc],
 obstacles: [{name: /dev/null, shape: sphere, radius: 0.1}, {name: /tmp, mesh: body.obj},
             {name: rest/l0.ply, animation: [body.obj, other.obj], translate: [0, 0, -9]}]})");
  for (const char* name : {"body.obj", "other.obj"})
    folder.write(name, "v 0 0 -3\nv 1 0 -3\nv 0 1 -3\nv 0 0 -4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const fs::path body = fs::canonical(folder / "body.obj"), other = fs::canonical(folder / "other.obj");
  CHECK((files_of(saved_config(experiment_in(folder / "e.yaml"))) == std::vector{body, body, other}));
  run_into("out", folder, "--method newton -q --set newton.max_steps=1", 1);
  CHECK(fs::exists(folder / "out/results.json"));
}

TEST_CASE("A run whose schedule selects ever more pinned vertices resumes while they are blocked") {
  const Scratch folder(R"({name: g, cloth: {shape: square, side: 0.4, vertices: 100}, levels: 1,
 start: {translate: [-0.2, -0.2, 0.12], perturbation: 1e-3},
 pins: [{region: ball, point: [0.2, 0.2, 0], radius: 0.05, translate: [-0.2, -0.2, 0.12]}],
 energies: [neo_hookean, hinge, gravity], methods: {newton: {}},
 contact: [shapes], obstacles: [{name: ball, shape: sphere, radius: 0.1}], friction: 0.3,
 schedule: {steps: 4, equilibrate: true, keys: [
   {parameter: pins.0.translate, times: [0, 1], values: [[-0.2, -0.2, 0.12], [-0.2, -0.2, 0.05]]},
   {parameter: pins.0.radius, times: [0, 1], values: [0.05, 0.12]}]}})");
  DrapeAtWork command("run e.yaml --out out --checkpoint 0 -q --no-report --measure", folder);
  wait_for_steps(command, folder / "out", 320);
  REQUIRE(command.ended_by(SIGINT).exit_code == 130);
  CHECK(drape_with("run --resume out -q --no-report --measure", folder.path).exit_code != 2);
  CHECK(is_complete(folder / "out"));
}

TEST_CASE("A run warm-starts from a saved state under changed parameters, in another folder") {
  const Scratch folder;
  interrupt_sheets(folder);
  const std::string flow =
      "run --resume out --quiet --no-report --measure --threads 1 --set newton.max_steps=4 ";
  const auto first_row = [&](const std::string& out) {
    const std::string text = text_of(folder / (out + "/iterations.csv"));
    return text.substr(text.find('\n') + 1, 10);
  };

  drape_ends(flow + "--out last", folder, 1);
  CHECK(first_row("last") == "pcs,1,0,0,");  // the level under way after 12 steps of 8 a level
  const nlohmann::json last = results_in(folder / "last");
  CHECK(last["warm_started_from"] == "out, method pcs, level 1");
  REQUIRE(last["methods"].size() == 1);
  REQUIRE(last["methods"]["pcs"]["levels"].size() == 2);
  CHECK(last["methods"]["pcs"]["levels"][0]["from_initial_state"] == true);

  drape_ends(flow + "--out soft --level 0 --set material.bending_modulus=1e3", folder, 1);
  CHECK(first_row("soft") == "pcs,0,0,0,");

  // It begins where the other run left the level: inertia holds the cloth there.
  const std::string hold = " --set newton.step_size=1e-7 --set newton.step_growth=1";
  drape_ends(flow + "--out held --level 0" + hold, folder, 1);
  drape_ends(sheets_run("start") + hold + " --set newton.max_steps=1", folder, 1);
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
    CHECK_THAT(refused(folder, flow + "--out x " + change), Contains(expected));
}
