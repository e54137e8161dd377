// What keeps a run from being resumed.

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/configs/resuming.h"
#include "tests/support/solve.h"

using namespace drape;

TEST_CASE("Checkpoints that cannot be resumed are refused with the reason") {
  const Scratch folder;
  interrupt_sheets(folder);
  const std::pair<std::string, std::string> options[] = {
      {"--resume nowhere", "nowhere: holds no run; give the results folder of one"},
      {"e.yaml --resume out", "takes the experiment from the run's own config.yaml; leave out e.yaml"},
      {"--resume out --overwrite", "leave out --overwrite"},
      {"--resume out --out other", "leave out --out"},
      {"--resume out --set newton.step_size=1", "is another run; name its folder with --out"},
      {"--resume out --set newton.step_size=1 --out ./out", "leaves the run that it begins from as it is"},
      {"e.yaml --level 1", "name its run with --resume"}};
  for (const auto& [arguments, expected] : options)
    CHECK_THAT(refused(folder, "run " + arguments), Contains(expected));

  const std::string missing = ": is missing, and the run cannot be resumed without: put it back, or run ";
  const auto check_refused_with = [&](const std::string& name, const std::string& instead,
                                      const std::string& expected) {
    const std::string whole = text_of(folder / name);
    if (instead.empty())
      fs::remove(folder / name);
    else
      folder.write(name, instead);
    CHECK_THAT(refused(folder, "run --resume out"), Contains(expected));
    folder.write(name, whole);
  };
  check_refused_with("out/config.yaml", text_of(folder / "out/config.yaml") + "# \n",
                     "out/config.yaml: is not the one that the checkpoint was made with");
  check_refused_with("out/rest/l0.ply", "ply\n", "out/rest/l0.ply: is not what it was when the run began");
  check_refused_with("out/iterations.csv", "method\n", "out/iterations.csv: is shorter than when ");
  for (const std::string name : {"out/iterations.csv", "out/log.jsonl"})
    check_refused_with(name, "", name + missing);
  {
    FileLock other(folder / "out/checkpoint/lock");
    REQUIRE(other.acquire(0));
    fs::resize_file(folder / "out/checkpoint/lock", 0);  // as before it has written who it is
    CHECK_THAT(refused(folder, "run --resume out"), Contains("out: another process uses this folder"));
    const std::string in_use = "uses this folder; wait for it, or stop it";
    CHECK_THAT(refused(folder, "run --resume out"), Contains(in_use));
    // Before the checkpoint is read, which the other process goes on to replace.
    check_refused_with("out/config.yaml", "name: other\n", in_use);
    check_refused_with("out/results.json", "{\"complete\": true}", in_use);
  }
  // It can be resumed all the same, on as many threads as its results tell.
  drape_ends(replaced(go_on, "--threads 1", "--threads 2"), folder, 1);
  const nlohmann::json all = results_in(folder / "out");
  CHECK(all["machine"]["threads"] == 1);
  REQUIRE(all["resumed"].size() == 1);
  CHECK(all["resumed"][0]["machine"]["threads"] == 2);
}

TEST_CASE("A changed rest shape of a cloth's file replaces no finer one") {
  const Scratch folder;
  write_sheets(folder);
  run_into("out", folder, "--method newton --levels 2 --set newton.max_steps=2", 1);
  TriangleMesh rest = read_mesh(folder / "out/rest/l0.ply");
  rest.vertices(0, 2) += 1e-3;
  write_mesh(folder / "out/rest/l0.ply", rest);
  CHECK_THAT(refused(folder, "run --resume out"), Contains("does not follow from rest/l0.ply"));
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
  const std::string before = text_of(folder / "out/log.jsonl");
  using C = Checkpoint&;
  using N = NewtonState&;  // of the level under way
  FrictionContact far{};
  far.vertices = {1 << 20, -1, -1, -1};
  const std::pair<std::string, std::function<void(C, N)>> misfits[] = {
      {"the method under way", [](C c, N) { c.method = 3; }},
      {"the method under way", [](C c, N) { c.method = -1; }},
      {"the experiment has no method", [](C c, N) { c.methods[0] = "x"; }},
      {"the level that the methods begin with", [](C c, N) { c.first_level = -1; }},
      {"the level under way", [](C c, N) { c.state.level = 1 << 30; }},
      {"the level under way", [](C, N n) { n.so_far.level += 1; }},
      {"the level before the one under way",
       [](C c, N n) {
         c.state.finished.back() = {};
         c.state.finished.back().level = c.state.level;
         c.state.finished.back().x = n.so_far.x;
       }},
      {"the lag of friction",
       [](C, N n) {
         n.contacts.damping = {0.5, {}};
       }},
      {"the lag of friction", [](C, N n) { n.contacts.damping.fraction = std::nan(""); }},
      {"the lag of friction", [](C, N n) { n.contacts.damping.lag.resize(7); }},
      {"the lag of friction",
       [&](C, N n) { n.contacts.damping.lag.assign(n.contacts.stiffness.size(), {{far}}); }},
      {"the state of level", [](C, N n) { n.so_far.x.conservativeResize(3, 3); }},
      {"the state of level", [](C, N n) { n.so_far.x(1, 1) = std::nan(""); }},
      {"negative counts", [](C, N n) { n.so_far.steps = -1; }},
      {"negative counts", [](C, N n) { n.so_far.saddles_left = -1; }},
      {"the exit from a saddle", [](C, N n) { n.check.strictness = std::nan(""); }},
      {"the exit from a saddle", [](C, N n) { n.saddle_exit.exits = -1; }},
      {"a Dirichlet vertex out of range", [](C, N n) { n.dirichlet.unsatisfied = {1 << 20}; }},
      {"the settings of the step", [](C, N n) { n.step.controller.step_size = std::nan(""); }},
      {"the settings of the step", [](C, N n) { n.step.factor.blend = -1; }},
      {"the settings of the step", [](C, N n) { n.step.factor.blend = 7; }},
      {"the response to an increment",
       [](C, N n) { n.load_stepper.response.predicted = Positions::Zero(1, 3); }},
      {"the contacts: ", [](C, N n) { n.contacts.reference.resize(0, 3); }},
      {"the contacts' tangential displacements", [](C, N n) { n.contacts.tangential_displacements.clear(); }},
      {"the contacts' stiffness", [](C, N n) { n.contacts.stiffness.clear(); }},
      {"the contacts' stiffness", [](C, N n) { n.contacts.stiffness.at(0) = -1; }},
      {"the contacts' stiffness", [](C, N n) { n.so_far.contact_stiffness = {1, 1, 1}; }},
      {"the matrix's pattern", [](C, N n) { n.step.factor.pattern.extra = {{{0, 1 << 20}}, {0}}; }},
      {"the matrix's pattern", [](C, N n) { n.step.factor.pattern.extra = {{{0, 1}}, {}}; }},
      {"the factor's ordering", [](C, N n) { n.step.factor.analysis.ordering.at(0) = -1; }},
      {"the factor's ordering", [](C, N n) { n.step.factor.analysis.fixed.pop_back(); }},
      {"results.json as it was", [](C c, N) { c.recorder.results = "{"; }},
      {"results.json as it was, of the method under way", [](C c, N) { c.recorder.method = "x"; }},
      {"a level's result", [](C c, N) { c.recorder.states = {{"pcs", 7, Positions()}}; }},
      {"the snapshots", [](C c, N) { c.recorder.snapshots.spacing = 0; }},
      {"the snapshots", [](C c, N) { c.recorder.states.at(0).snapshots = {}; }}};
  for (const auto& [what, change] : misfits) {
    InterruptedRun other = interrupted();
    change(other.checkpoint, *other.checkpoint.state.under_way);
    INFO(what);
    CHECK_THROWS_WITH(resume_experiment(experiment, *scene, silent(folder / "out"), std::move(other)),
                      Contains("the checkpoint does not fit its experiment: " + what));
  }
  CHECK(text_of(folder / "out/log.jsonl") == before);
}

TEST_CASE("An obstacle's mesh that changed since is named") {
  const Scratch folder(replaced(experiment_of_tests("contact"), "obstacles: [",
                                "obstacles: [{mesh: box.obj, translate: [0, 0, -1]}, "));
  write_mesh(folder / "box.obj", grid({0.4, 0.4}, 2, 2, Diagonals::one_way));
  DrapeAtWork command(sheets_run("out"), folder);
  wait_for_steps(command, folder / "out", 3);
  command.ended_by(SIGKILL);
  write_mesh(folder / "box.obj", grid({0.5, 0.4}, 2, 2, Diagonals::one_way));
  CHECK_THAT(refused(folder, "run --resume out"), Contains("box.obj: is not what it was when the run began"));
  fs::remove(folder / "box.obj");
  CHECK_THAT(refused(folder, "run --resume out"), Contains("box.obj"));
}

TEST_CASE("A run that ended before its first checkpoint says how to begin again") {
  const Scratch folder(small_experiment());
  fs::create_directories(folder / "out/checkpoint");
  folder.write("out/checkpoint/lock", "");
  check_error(
      refused(folder, "run --resume out"),
      "out: holds no checkpoint of a run: one that ended before its first method began has none. Run the "
      "experiment again with --overwrite, or give ");
  run_into("out", folder, "--overwrite --levels 1 --method pcs");
}
