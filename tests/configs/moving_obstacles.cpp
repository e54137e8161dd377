// Runs whose obstacles and loads change as their schedule says.

#include "core/app/files/csv.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/configs/runs.h"

using drape::Positions;

namespace {

/// Runs by PCS, checks that no state has an intersection, and gives the finest state.
Positions end_of(const std::string& experiment, const Scratch& folder) {
  folder.write("e.yaml", experiment + "check_intersections: every_step\nmethods: {pcs: {}}\n");
  run_into("out", folder, "--overwrite");
  const auto pcs = results_in(folder / "out")["methods"]["pcs"];
  CHECK(pcs["status"] == "converged");
  for (const auto& level : pcs["levels"]) CHECK(level["intersections"] == 0);
  return drape::read_mesh(folder / ("out/" + pcs["levels"].back()["mesh"].get<std::string>())).vertices;
}

/// The part of an experiment by which a parameter of its obstacle changes.
std::string scheduled(int steps, const std::string& parameter, const std::string& from,
                      const std::string& to) {
  return "schedule: {steps: " + std::to_string(steps) +
         ", equilibrate: true, keys: [{parameter: obstacles.0." + parameter + ", times: [0, 1], values: [" +
         from + ", " + to + "]}]}\n";
}

}  // namespace

TEST_CASE("a cloth that lies on a plate with friction goes with it, as far as it goes") {
  const std::string on_plate = R"(name: dragged
cloth: {shape: square, side: 0.2, columns: 6, rows: 6}
levels: 1
start: {translate: [-0.1, -0.1, 0.0009]}
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-2, step_size: 0.1, iterations_per_step: 30}
friction: 0.3
contact: )";
  const std::string ipc = "{type: ipc, self_contact: false}\nobstacles: [{meshed_shape",
                    shapes = "shapes\nobstacles: [{shape";
  const Eigen::RowVector3d way(0.06, -0.03, 0);
  for (const auto& [contact, from, to] : {std::tuple(ipc, "[0.06, 0.07, -0.05]", "[0.12, 0.04, -0.05]"),
                                          {shapes, "[0, 0, -0.05]", "[0.06, -0.03, -0.05]"}}) {
    INFO(contact);
    const Scratch folder;
    const std::string lying =
        on_plate + contact + ": box, size: [0.5, 0.5, 0.1], translate: " + from + "}]\n";
    const Positions still = end_of(lying, folder);
    const Positions moved = end_of(lying + scheduled(10, "translate", from, to), folder);
    CHECK((moved.colwise().mean() - still.colwise().mean() - way).norm() < 2e-4);
  }
}

TEST_CASE("an obstacle moves the cloth far by more than a tenth of the contact's dhat at a time") {
  const std::string draped = R"(name: pushed
cloth: {shape: square, side: 0.4, columns: 14, rows: 14}
levels: 1
start: {translate: [-0.2, -0.2, 0.11], perturbation: 1e-3}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.0608}, gravity]
newton: {force_tolerance: 1e-3}
friction: 0.3
)";
  const std::string
      shapes = "contact: [ipc, shapes]\nobstacles: [{name: ball, shape: sphere, radius: 0.1}]\n",
      ipc = "contact: ipc\nobstacles: [{name: ball, meshed_shape: sphere, radius: 0.1, subdivisions: 3}]\n";
  const Scratch folder;
  const auto iterations = [&](const std::string& more) {
    end_of(draped + more, folder);
    return results_in(folder / "out")["methods"]["pcs"]["levels"][0]["iterations"].get<int>();
  };
  const int still = iterations(shapes);  // one part at a time, 3000 to 6000 more
  CHECK(iterations(shapes + scheduled(2, "translate", "[0, 0, 0]", "[0, 0, 0.1]")) < still + 150);
  CHECK(iterations(shapes + scheduled(2, "translate", "[0, 0, 0]", "[0.1, 0, 0]")) < still + 300);
  CHECK(iterations(shapes + scheduled(2, "radius", "0.1", "0.13")) < still + 1500);
  CHECK(iterations(ipc + scheduled(2, "translate", "[0, 0, 0]", "[0, 0.05, 0.1]")) < still + 300);
}

TEST_CASE("a ball with cages rises into a cloth that is held at its corners, which lies on the ball itself") {
  const Scratch folder;
  const Positions x = end_of(R"(name: pushed
cloth: {shape: square, side: 0.4, columns: 9, rows: 9}
levels: 2
start: {translate: [-0.2, -0.2, 0]}
pins: [{point: [0, 0, 0]}, {point: [0, 0.4, 0]}, {point: [0.4, 0, 0]}, {point: [0.4, 0.4, 0]}]
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-2, step_size: 0.05}
friction: 0.1
contact: ipc
obstacles:
  - {name: ball, meshed_shape: sphere, radius: 0.05, subdivisions: 2, translate: [0, 0, -0.2],
     cages: {count: 1, alpha: 0.1, offset: 0.03}}
schedule: {steps: 10, keys: [
  {parameter: obstacles.0.translate, times: [0, 1], values: [[0, 0, -0.2], [0, 0, -0.05]]}]}
)",
                             folder);
  CHECK(x.col(2).maxCoeff() > 5e-4);  // on the ball's top, at 0, and not its cage's, at 5 mm
  CHECK(x.col(2).maxCoeff() < 3e-3);
}

TEST_CASE("errors are measured under the last load, whichever method was stopped before it") {
  const Scratch folder(
      R"({name: lifted, cloth: {shape: rectangle, size: [0.2, 0.05], triangulation: one_way, vertices: 40},
 levels: 1, energies: [neo_hookean, hinge, gravity],
 pins: [{region: box, lower: [0, 0, 0], upper: [0, 0.05, 0]}],
 schedule: {steps: 4, equilibrate: true, keys: [
   {parameter: energies.gravity.acceleration, times: [0, 1], values: [[0, 0, -9.81], [0, 0, 9.81]]}]},
 newton: {force_tolerance: 1e-4}, reference: {method: whole, force_tolerance: 1e-6},
 methods: {whole: {type: newton}, stopped: {type: newton, newton: {max_steps: 1}}}})");
  drape_with("run e.yaml --out out --method all --quiet --no-report --measure", folder.path);
  // Its own end is the reference but for the tighter tolerance.
  const drape::Csv rows(folder / "out/errors.csv");
  double last = 1;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows.text(k, "method") == "whole") last = rows.number(k, "reference_rms").value();
  CHECK(last < 1e-3);
}

TEST_CASE("seconds of increments leave out what recording takes, as those of levels do") {
  const Scratch folder(R"({name: heavier, cloth: {shape: square, side: 0.4, columns: 6, rows: 6}, levels: 2,
 pins: [{point: [0, 0, 0]}], energies: [neo_hookean, hinge, gravity], newton: {force_tolerance: 1e-2},
 schedule: {steps: 5, equilibrate: true, keys: [
   {parameter: energies.gravity.acceleration, times: [0, 1], values: [[0, 0, -9.81], [1, 0, -9.81]]}]},
 methods: {pcs: {}}})");
  run_into("out", folder, "--checkpoint 0");
  const auto pcs = results_in(folder / "out")["methods"]["pcs"];
  double sums[] = {0, 0};
  for (const auto& increment : pcs["increments"])
    sums[increment["level"].get<int>()] += increment["seconds"].get<double>();
  for (const int level : {0, 1}) {
    const double level_seconds = pcs["levels"][level]["seconds"].get<double>();
    CHECK(sums[level] > 0.5 * level_seconds);
    CHECK(sums[level] <= 1.001 * level_seconds);
  }
}
