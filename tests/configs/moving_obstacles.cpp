// Runs whose obstacles and loads change as their schedule says.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/files/csv.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"

using drape::Positions;

namespace {

/// Runs, checks that no state has an intersection, and gives the finest state.
Positions end_of(const std::string& experiment, const Scratch& folder, int finest) {
  folder.write("e.yaml", experiment);
  drape_ends("run e.yaml --out out --overwrite --quiet --no-report", folder);
  const auto all = json_in(folder / "out/results.json");
  CHECK(all["methods"]["pcs"]["status"] == "converged");
  REQUIRE(all["methods"]["pcs"]["levels"].size() == static_cast<std::size_t>(finest + 1));
  for (const auto& level : all["methods"]["pcs"]["levels"]) CHECK(level["intersections"] == 0);
  return drape::read_mesh(folder / ("out/levels/pcs_l" + std::to_string(finest) + ".ply")).vertices;
}

const std::string pinned = R"(name: pushed
cloth: {shape: square, side: 0.4, columns: 9, rows: 9}
levels: 2
start: {translate: [-0.2, -0.2, 0]}
pins:
  - {region: ball, point: [0, 0, 0], radius: 0.01}
  - {region: ball, point: [0, 0.4, 0], radius: 0.01}
  - {region: ball, point: [0.4, 0, 0], radius: 0.01}
  - {region: ball, point: [0.4, 0.4, 0], radius: 0.01}
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-2, step_size: 0.05}
check_intersections: every_step
methods: {pcs: {}}
)";

}  // namespace

TEST_CASE("a cloth that lies on a plate with friction goes with it, as far as it goes") {
  const std::string on_plate = R"(name: dragged
cloth: {shape: square, side: 0.2, columns: 6, rows: 6}
levels: 1
start: {translate: [-0.1, -0.1, 0.0009]}
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-2, step_size: 0.1, iterations_per_step: 30}
check_intersections: every_step
methods: {pcs: {}}
)";
  const std::string ipc = R"(contact: {type: ipc, self_contact: false}
friction: 0.3
obstacles: [{name: plate, meshed_shape: box, size: [0.5, 0.5, 0.1], translate: [0.06, 0.07, -0.05]}]
schedule: {steps: 10, equilibrate: true, keys: [
  {parameter: obstacles.0.translate, times: [0, 1], values: [[0.06, 0.07, -0.05], [0.12, 0.04, -0.05]]}]}
)";
  const std::string shapes = R"(contact: shapes
friction: 0.3
obstacles: [{name: plate, shape: box, size: [0.5, 0.5, 0.1], translate: [0, 0, -0.05]}]
schedule: {steps: 10, equilibrate: true, keys: [
  {parameter: obstacles.0.translate, times: [0, 1], values: [[0, 0, -0.05], [0.06, -0.03, -0.05]]}]}
)";
  const Eigen::RowVector3d way(0.06, -0.03, 0);
  for (const std::string& contact : {ipc, shapes}) {
    INFO(contact);
    const Scratch folder;
    const Positions still = end_of(on_plate + contact.substr(0, contact.find("schedule")), folder, 0);
    const Positions moved = end_of(on_plate + contact, folder, 0);
    CHECK((moved.colwise().mean() - still.colwise().mean() - way).norm() < 2e-4);
  }
}

TEST_CASE("a plate that rises under a pinned cloth and turns there pushes it, and never passes through") {
  for (const std::string plate : {"contact: ipc\nobstacles: [{name: plate, meshed_shape: box, ",
                                  "contact: [ipc, shapes]\nobstacles: [{name: plate, shape: box, "}) {
    INFO(plate);
    const Scratch folder;
    const Positions x = end_of(pinned + plate + R"(size: [0.2, 0.1, 0.004], translate: [0, 0, -0.1]}]
friction: 0.1
schedule: {steps: 10, keys: [
  {parameter: obstacles.0.translate, times: [0, 1], values: [[0, 0, -0.1], [0, 0, -0.02]]},
  {parameter: obstacles.0.rotate, times: [0, 1], values: [[0, 0, 0], [20, 0, 200]]}]}
)",
                               folder, 1);
    CHECK(x.col(2).minCoeff() < -0.02);  // it hangs over the plate's ends
    // The run's folder has the obstacle where the schedule ends.
    CHECK(drape::read_mesh(folder / "out/obstacles/0.ply").vertices.col(2).mean() == Approx(-0.02));
  }
}

TEST_CASE(
    "an obstacle that pushes or drags the cloth far moves it, by more than a tenth of the contact's dhat at "
    "a time") {
  const std::string draped = R"(name: pushed
cloth: {shape: square, side: 0.4, columns: 14, rows: 14}
levels: 1
start: {translate: [-0.2, -0.2, 0.11], perturbation: 1e-3}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.0608}, gravity]
newton: {force_tolerance: 1e-3}
check_intersections: every_step
methods: {pcs: {}}
)";
  const std::string shapes = R"(contact: [ipc, shapes]
friction: 0.3
obstacles: [{name: ball, shape: sphere, radius: 0.1}]
)";
  const std::string ipc = R"(contact: ipc
friction: 0.3
obstacles: [{name: ball, meshed_shape: sphere, radius: 0.1, subdivisions: 3}]
)";
  const auto schedule = [](const std::string& key, const std::string& to) {
    return "schedule: {steps: 2, equilibrate: true, keys: [{parameter: " + key +
           ", times: [0, 1], values: " + to + "}]}\n";
  };
  const Scratch folder;
  const auto iterations = [&](const std::string& more) {
    end_of(draped + more, folder, 0);
    const auto all = json_in(folder / "out/results.json");
    return all["methods"]["pcs"]["levels"][0]["iterations"].get<int>();
  };
  const int still = iterations(shapes);  // one part at a time, 3000 to 6000 more
  CHECK(iterations(shapes + schedule("obstacles.0.translate", "[[0, 0, 0], [0, 0, 0.1]]")) < still + 150);
  CHECK(iterations(shapes + schedule("obstacles.0.translate", "[[0, 0, 0], [0.1, 0, 0]]")) < still + 300);
  CHECK(iterations(shapes + schedule("obstacles.0.radius", "[0.1, 0.13]")) < still + 1500);
  CHECK(iterations(ipc + schedule("obstacles.0.translate", "[[0, 0, 0], [0, 0.05, 0.1]]")) < still + 300);
}

TEST_CASE("a wing that flaps under a pinned cloth, and a ball with cages that rises into it") {
  const Scratch folder;
  for (int k = 0; k < 3; ++k) {
    drape::TriangleMesh wing = drape::grid({0.2, 0.2}, 5, 5, drape::Diagonals::one_way);
    wing.vertices.rowwise() -= Eigen::RowVector3d(0.1, 0.1, 0.1);
    for (int v = 0; v < wing.vertices.rows(); ++v)
      wing.vertices(v, 2) += (k == 1 ? 1.5 : -0.5) * wing.vertices(v, 0);
    drape::write_mesh(folder / ("wing" + std::to_string(k) + ".ply"), wing);
  }
  end_of(pinned + R"(contact: ipc
friction: 0.1
obstacles: [{name: wing, animation: [wing0.ply, wing1.ply, wing2.ply]}]
schedule: {steps: 12, keys: [{parameter: obstacles.0.frame, times: [0, 1], values: [0, 2]}]}
)",
         folder, 1);
  const Positions x = end_of(pinned + R"(contact: ipc
friction: 0.1
obstacles:
  - {name: ball, meshed_shape: sphere, radius: 0.05, subdivisions: 2, translate: [0, 0, -0.2],
     cages: {count: 1, alpha: 0.1, offset: 0.03}}
schedule: {steps: 10, keys: [
  {parameter: obstacles.0.translate, times: [0, 1], values: [[0, 0, -0.2], [0, 0, -0.05]]}]}
)",
                             folder, 1);
  CHECK(x.col(2).maxCoeff() > 5e-4);  // on the ball's top, at 0, and not its cage's, at 5 mm
  CHECK(x.col(2).maxCoeff() < 3e-3);
}

TEST_CASE("errors are measured under the last load, whichever method was stopped before it") {
  const Scratch folder(R"(name: lifted
cloth: {shape: rectangle, size: [0.2, 0.05], triangulation: one_way, vertices: 40}
levels: 1
pins: [{region: box, lower: [0, 0, 0], upper: [0, 0.05, 0]}]
energies: [neo_hookean, hinge, gravity]
schedule: {steps: 4, equilibrate: true, keys: [
  {parameter: energies.gravity.acceleration, times: [0, 1], values: [[0, 0, -9.81], [0, 0, 9.81]]}]}
newton: {force_tolerance: 1e-4}
methods:
  whole: {type: newton}
  stopped: {type: newton, newton: {max_steps: 1}}
reference: {method: whole, force_tolerance: 1e-6}
)");
  drape_with("run e.yaml --out out --method all --quiet --no-report", folder.path);
  // Its own end is the reference but for the tighter tolerance.
  const drape::Csv rows(folder / "out/errors.csv");
  double last = 1;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows.text(k, "method") == "whole") last = rows.number(k, "reference_rms").value();
  CHECK(last < 1e-3);
}

TEST_CASE("seconds of increments leave out what recording takes, as those of levels do") {
  const Scratch folder(R"(name: heavier
cloth: {shape: square, side: 0.4, columns: 6, rows: 6}
levels: 2
pins: [{region: ball, point: [0, 0, 0], radius: 0.01}]
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-2}
schedule: {steps: 5, equilibrate: true, keys: [{parameter: energies.gravity.acceleration, times: [0, 1], values: [[0, 0, -9.81], [1, 0, -9.81]]}]}
methods: {pcs: {}}
)");
  drape_ends("run e.yaml --out out --quiet --no-report --checkpoint 0", folder);
  const auto pcs = json_in(folder / "out/results.json")["methods"]["pcs"];
  double sums[] = {0, 0};
  for (const auto& increment : pcs["increments"])
    sums[increment["level"].get<int>()] += increment["seconds"].get<double>();
  for (const int level : {0, 1}) {
    CHECK(sums[level] > 0);
    CHECK(sums[level] <= 1.001 * pcs["levels"][level]["seconds"].get<double>());
  }
}
