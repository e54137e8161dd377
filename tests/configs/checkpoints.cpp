// Runs that are stopped at every step and go on end with the bits of one that was not.

#include "core/numerics/mesh_files/io.h"
#include "tests/configs/resuming.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Some steps a level, in which the sheets come to touch each other and the ball; with these settings.
Overrides some_steps(const Overrides& more) {
  Overrides all = {{"start.translate", "[-0.2, -0.2, 0.1015]"}, {"newton.max_steps", "8"}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
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
  REQUIRE(results_in(folder / "whole")["complete"] == true);

  int parts = 1, patience = 2, asked = 0;
  RunOptions options = silent(folder / "parts");
  options.stop = [&] { return ++asked > patience; };
  run_experiment(experiment, *scene_of(experiment), options);
  for (std::string before; !is_complete(options.out); ++parts) {
    REQUIRE(parts < 2000);
    std::vector<std::string> warnings;
    InterruptedRun interrupted = interrupted_run(RunFolder::of_run(options.out), warnings);
    CHECK(warnings.empty());
    const MethodState& state = interrupted.checkpoint.state;
    const std::string now = std::to_string(interrupted.checkpoint.method) + " " +
                            std::to_string(state.level) + " " +
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
  const Scratch folder(small_experiment()), compared(small_experiment());
  CHECK(check_in_parts(folder, {{"levels", "3"}, {"newton.max_steps", "8"}}) > 60);
  const std::string reference = "{file: " + (folder / "whole/levels/pcs_l2.ply").string() + "}";
  CHECK(check_in_parts(compared, {{"levels", "3"}, {"newton.max_steps", "2"}, {"reference", reference}}) > 5);
}

TEST_CASE("So does one with self-contact, obstacles, friction and a strain limit, however Newton solves it") {
  // A stop is asked for within steps of two iterations too, and such a part leads nowhere: more steps.
  const std::pair<Overrides, int> cases[] = {
      {{}, 60},
      {{{"newton.linear_solver", "multigrid"}}, 60},
      {{{"newton.iterations_per_step", "2"}, {"newton.max_steps", "12"}}, 60},
      {{{"newton.form", "static"}, {"newton.psd_blend", "full"}, {"levels", "2"}}, 20}};
  for (const auto& [settings, parts] : cases) {
    INFO((settings.empty() ? "as it is" : settings[0].key));
    const Scratch folder;
    write_sheets(folder);
    CHECK(check_in_parts(folder, some_steps(settings)) > parts);
  }
}

TEST_CASE("So does one of PCS whose levels relax, into a matrix of the same pattern or another") {
  const std::string refined =
      "{pcs: {interpolation: {membrane: refiner, bending: refiner, external: refiner}}}";
  for (const auto& [name, tolerance] : {std::pair("golden", "1e-8"), {"contact", "1e-4"}})
    for (const std::string& methods : {std::string("{pcs: {}}"), refined}) {
      INFO(name << ": " << methods);
      int relaxing = 0;
      CHECK(check_in_parts(Scratch(experiment_of_tests(name)),
                           {{"levels", "2"},
                            {"cloth.columns", "5"},
                            {"cloth.rows", "5"},
                            {"reference", "pcs"},
                            {"methods", methods},
                            {"newton.force_tolerance", tolerance}},
                           [&](const NewtonState& state) { relaxing += state.switched_to_plain; }) > 15);
      CHECK(relaxing > 1);
    }
}

TEST_CASE("So does one whose contact stiffness is raised") {
  const Scratch folder(drum("7", "2", "5", "pcs"));
  CHECK(check_in_parts(folder, {}) > 20);
  const nlohmann::json levels = results_in(folder / "whole")["methods"]["pcs"]["levels"];
  const double own = 10 * 9.81 * 5 * 3e-4;
  // That of the model whose ball carries, on both levels, and the next level begins with it.
  for (const int level : {0, 1}) {
    const auto stiffness = levels[level]["contact_stiffness"].get<std::vector<double>>();
    CHECK(stiffness[0] == Approx(own));
    CHECK(stiffness[1] == Approx((level == 0 ? 4 : 16) * own));
  }
}

TEST_CASE("So does one under load stepping, with pins that are stopped on their way and moving obstacles") {
  // The ball rises into the sheets, which are held at two corners and become softer. One corner is pulled
  // farther up at once than the strain limit lets it.
  const std::string schedule = R"(
pins:
  - {region: vertices, vertices: [0], translate: [-0.2, -0.2, 0.1015]}
  - {region: vertices, vertices: [35], translate: [-0.2, -0.2, 0.1015]}
schedule: {steps: 6, keys: [
  {parameter: material.bending_modulus, times: [0, 0.5], values: [8e4, 8e3], interpolation: log},
  {parameter: obstacles.0.translate, times: [0, 1], values: [[0, 0, 0], [0, 0, 0.03]]},
  {parameter: pins.1.translate, times: [0, 0.5, 1],
   values: [[-0.2, -0.2, 0.1015], [-0.2, -0.2, 0.3], [-0.2, -0.2, 0.1015]]},
  {parameter: energies.strain_limit.limit, times: [0, 1], values: [1.06, 1.04]}]}
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
  const std::string schedule =
      "{steps: 2, equilibrate: true, keys: [{parameter: obstacles.0.translate, times: [0, 1], values: [[0, "
      "0, "
      "0], [0, 0, 0.05]]}]}";
  const int parts =
      check_in_parts(Scratch(experiment_of_tests("contact")), {{"cloth.columns", "8"},
                                                               {"cloth.rows", "8"},
                                                               {"levels", "1"},
                                                               {"energies", "[neo_hookean, hinge, gravity]"},
                                                               {"friction", "0.3"},
                                                               {"methods", "{pcs: {}}"},
                                                               {"schedule", schedule}});
  CHECK(parts > 40);
  CHECK(parts < 300);  // by a tenth of a millimetre at a time there would be a thousand
}

TEST_CASE("So does one of PCS whose schedule leaves a pin with a single vertex") {
  const Scratch folder(
      R"({name: clip, cloth: {shape: square, side: 0.4, columns: 5, rows: 5}, levels: 2,
 start: {perturbation: 1e-3}, energies: [neo_hookean, hinge, gravity],
 pins: [{region: ball, point: [0, 0, 0], radius: 0.11}],
 schedule: {steps: 2, equilibrate: true, keys: [
   {parameter: pins.0.radius, times: [0, 1], values: [0.11, 0.001]}]},
 newton: {force_tolerance: 0.1, max_steps: 30}, methods: {pcs: {}}})");
  CHECK(check_in_parts(folder, {}) > 20);
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
  const Scratch folder(replaced(text_of(folders::source() / "configs/hard/drape.yaml"),
                                "{shape: square, side: 1, columns: 16, rows: 16}",
                                "{shape: file, file: fan.obj}"));
  write_mesh(folder / "fan.obj", fan);
  CHECK(
      check_in_parts(folder, {{"start.translate", "[-0.5, -0.3, 0.32]"},
                              {"start.perturbation", "1e-6"},
                              {"methods", "{cascadic: {}}"},
                              {"snapshots", "2"},
                              {"newton.max_steps", "60"},
                              {"schedule",
                               "{steps: 3, keys: [{parameter: energies.gravity.acceleration, times: [0, 1], "
                               "values: [[0, 0, -9.81], [1, 0, -9.81]]}]}"}}) > 15);
  const nlohmann::json levels = results_in(folder / "parts")["methods"]["cascadic"]["levels"];
  REQUIRE(levels.size() == 2);
  CHECK_THAT(levels[1]["message"].get<std::string>(), Contains("starts from the scene's start instead"));
}

TEST_CASE("The obstacles of a stopped run are where its schedule has come to, and resuming moves them on") {
  const Scratch folder(R"({name: raised, cloth: {shape: square, side: 0.4, columns: 3, rows: 3}, levels: 1,
 pins: [{point: [0, 0, 0]}], energies: [neo_hookean, hinge, gravity],
 contact: shapes, obstacles: [{shape: sphere, radius: 0.1}], newton: {force_tolerance: 1e-2, max_steps: 20},
 schedule: {steps: 8, keys: [
   {parameter: obstacles.0.translate, times: [0, 1], values: [[2, 0, 0], [2, 0, 0.8]]}]},
 methods: {pcs: {}, newton: {}}})");
  const fs::path out = folder / "out", ball = out / "obstacles/0.ply";
  const auto height = [&] { return read_mesh(ball).vertices.col(2).mean(); };
  const Experiment experiment = experiment_in(folder / "e.yaml");
  RunOptions options = silent(out);
  int asked = 0;
  options.stop = [&] { return ++asked > 4; };
  run_experiment(experiment, *scene_of(experiment), options);
  CHECK(height() > 0.09);
  CHECK(height() < 0.75);
  const auto check_resumed = [&](bool restored) {
    std::vector<std::string> warnings;
    resume_experiment(experiment, *scene_of(experiment), options,
                      interrupted_run(RunFolder::of_run(out), warnings));
    CHECK(height() == Approx(0.8));
    CHECK((text_of(out / "log.jsonl").find("file_restored") != std::string::npos) == restored);
  };
  asked = 0;
  options.stop = [&] { return results_in(out)["methods"].contains("newton") && ++asked > 3; };
  check_resumed(false);  // pcs to its end, then newton's first steps
  fs::remove(ball);
  check_resumed(true);
}
