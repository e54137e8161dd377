#include <catch2/catch.hpp>

#include "core/numerics/model/stretch_limit.h"
#include "tests/support/elastica.h"
#include "tests/support/stepped.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

/// A square above a ball, of which one pin is moved down onto it, and back up in the second half of the steps
/// if asked for.
std::string dragged_onto_a_ball(int levels, int steps, bool and_back = false) {
  const std::string up = "[-0.25, -0.25, 0.22]", down = "[-0.25, -0.25, 0.1]";
  const std::string way = and_back ? "times: [0, 1, 2], values: [" + up + ", " + down + ", " + up + "]"
                                   : "times: [0, 1], values: [" + up + ", " + down + "]";
  return R"(
name: dragged
cloth: {shape: square, side: 0.5, columns: 10, rows: 10}
start: {translate: [-0.25, -0.25, 0.22]}
pins:
  - {region: nearest, point: [0.222, 0.222, 0], translate: [-0.25, -0.25, 0.22]}
  - {region: nearest, point: [0, 0, 0]}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{name: ball, shape: sphere, radius: 0.2}]
methods: {pcs: {}}
)" + std::string("levels: ") +
         std::to_string(levels) + "\nschedule: {steps: " + std::to_string(steps) +
         ", keys: [{parameter: pins.0.translate, " + way + "}]}\n";
}

}  // namespace

TEST_CASE("A strip that is lifted by its end while its weight grows follows the cantilever's tables",
          "[physics]") {
  const int cells = 40;
  BeamStrip strip{cells};
  strip.stiffness = strip.density * 9.81 * strip.thickness;  // Γ = 1 under full weight
  Stepped s(strip.yaml("[neo_hookean, hinge, gravity]", R"(
newton: {step_size: 0.1, step_growth: 2, force_tolerance: 1e-4, max_steps: 500}
schedule:
  steps: 6
  equilibrate: true
  keys:
    - {parameter: energies.gravity.acceleration, times: [0, 3, 4, 5, 6], interpolation: linear,
       values: [[0, 0, -0.981], [0, 0, -9.81], [0, 0, -49.05], [0, 0, -196.2], [0, 0, -981]]}
    - {parameter: pins.0.translate, times: [0, 6], values: [[0, 0, 0], [0.3, -0.2, 0.9]]}
)"));
  INFO(s.levels[0].message);
  REQUIRE(s.levels[0].outcome == Outcome::converged);
  REQUIRE(s.rows.size() == 7);
  row("\nTip angle [degrees] of a cantilever that is moved while its weight grows");
  row("%8s %12s %12s %8s", "gamma", "hinge", "exact", "steps");
  const std::pair<int, double> loads[] = {{0, 0.1}, {3, 1}, {4, 5}, {5, 20}, {6, 100}};
  for (const auto& [increment, gamma] : loads) {
    const double exact = cantilever_under_weight(gamma).tip * 180 / M_PI;
    s.levels[0].x = s.states[increment];
    const double angle = tip_angle(s, cells);
    row("%8g %12.5f %12.5f %8d", gamma, angle, exact, s.rows[increment].steps);
    CHECK(std::abs(angle - exact) < 0.02);
    // The clamp reaches its target exactly.
    const Eigen::Vector3d moved = Eigen::Vector3d(0.3, -0.2, 0.9) * (increment / 6.0);
    CHECK((s.states[increment].row(0) - s.rest().row(0) - moved.transpose()).norm() < 1e-15);
  }
}

TEST_CASE("A ribbon that is slowly twisted and untwisted recovers its energy", "[physics]") {
  Stepped s(R"(
name: ribbon
cloth: {shape: rectangle, size: [0.4, 0.05], triangulation: criss_cross, columns: 33, rows: 5}
levels: 1
material: {density: 400, thickness: 4e-4, membrane_modulus: 1e6, bending_modulus: 1e6, poisson_ratio: 0.3}
start: {perturbation: 1e-3}
pins:
  - {region: box, lower: [-1, -1, -1], upper: [0.013, 1, 1], translate: [0, 0, 0]}
  - {region: box, lower: [0.387, -1, -1], upper: [1, 1, 1], translate: [-0.02, 0, 0], centre: [0.4, 0.025, 0]}
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-5}
schedule:
  steps: 12
  equilibrate: true
  keys:
    - {parameter: pins.1.rotate, times: [0, 1, 2], values: [[0, 0, 0], [60, 0, 0], [0, 0, 0]]}
methods: {newton: {}}
)");
  INFO(s.levels[0].message);
  REQUIRE(s.levels[0].outcome == Outcome::converged);
  REQUIRE(s.rows.size() == 13);
  row("\nEnergy [J] of a ribbon, its end turned");
  for (const IncrementRow& r : s.rows)
    row("%8.3f %14.8f %6d steps", 60 * (r.time <= 1 ? r.time : 2 - r.time), r.energy, r.steps);
  const double before = s.rows.front().energy, twisted = s.rows[6].energy;
  REQUIRE(std::abs(twisted - before) > 0.1 * std::abs(before));
  CHECK(std::abs(s.rows.back().energy - before) < 1e-5 * std::abs(before));
  for (std::size_t k = 1; k < 6; ++k) {  // the same angle on the way there and back
    const double there = s.rows[k].energy, back = s.rows[12 - k].energy;
    CHECK(std::abs(back - there) < 1e-4 * std::abs(there));
  }
}

TEST_CASE("Handles carry the weight by their displacement", "[physics]") {
  const double stiffness = 2000;
  for (const int levels : {1, 2}) {
    Stepped s(R"(
name: carried
cloth: {shape: square, side: 0.2, columns: 9, rows: 9}
levels: )" + std::to_string(levels) +
              R"(
handles:
  - {region: nearest, point: [0, 0, 0], stiffness: 2000}
  - {region: nearest, point: [0.2, 0, 0], stiffness: 2000}
  - {region: nearest, point: [0, 0.2, 0], stiffness: 2000}
  - {region: nearest, point: [0.2, 0.2, 0], stiffness: 2000}
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-7}
methods: {pcs: {}}
)");
    REQUIRE(s.levels.back().outcome == Outcome::converged);
    const Level& coarsest = s.scene->hierarchy.levels[0];
    const double area_density = s.model().material().area_density();
    double pull = 0;
    for (const int v : {0, 8, 72, 80})
      pull += stiffness * area_density * coarsest.vertex_area[v] * (s.rest()(v, 2) - s.x()(v, 2));
    CHECK(pull == Approx(9.81 * area_density * 0.04).epsilon(1e-6));
  }
}

TEST_CASE("A pin that is dragged into an obstacle stops there and is named", "[physics]") {
  const Stepped s(dragged_onto_a_ball(2, 3));
  REQUIRE(s.levels.size() == 2);
  for (const LevelResult& level : s.levels) {
    CHECK(level.outcome == Outcome::infeasible);
    CHECK_THAT(level.message,
               Catch::StartsWith(std::string(level.level == 0 ? "at pseudo-time 0.333 " : "") +
                                 "pin 0 stopped 0.0") &&
                   Catch::Contains(" short of its target (vertex 44), blocked by cloth triangle ") &&
                   Catch::EndsWith("and ball: sphere; the rest of the cloth is at equilibrium"));
    CHECK(level.force_residual <= 1e-3);
    const double above = level.x.row(44).norm() - 0.2;
    CHECK(above > 0);
    CHECK(above < 1e-3);
  }
  CHECK(s.intersections == 0);
}

TEST_CASE("A pin that stopped short of its target is named where the level ends without equilibrium too",
          "[physics]") {
  const std::string scene = dragged_onto_a_ball(1, 1);
  // Short steps approach the equilibrium slowly, after the target has been found infeasible.
  const std::string newton = "newton: {step_size: 0.02, step_growth: 1, force_tolerance: 1e-6, max_steps: ";
  const Stepped whole(scene + newton + "5000}\n");
  REQUIRE(whole.levels[0].outcome == Outcome::infeasible);
  REQUIRE(!whole.rows.empty());
  const Stepped cut(scene + newton + std::to_string(whole.rows.back().steps - 1) + "}\n");
  CHECK(cut.levels[0].outcome == Outcome::max_steps_reached);
  CHECK_THAT(cut.levels[0].message,
             Catch::StartsWith("no equilibrium within max_steps = ") &&
                 Catch::Contains("; pin 0 stopped 0.0") &&
                 Catch::Contains(" short of its target (vertex 44), blocked by cloth triangle "));
}

TEST_CASE("A target that an earlier increment did not reach stays in the level's message", "[physics]") {
  const Stepped s(dragged_onto_a_ball(1, 4, true));
  REQUIRE(s.levels.size() == 1);
  CHECK(s.levels[0].outcome == Outcome::converged);
  CHECK_THAT(s.levels[0].message, Catch::StartsWith("at pseudo-time 0.5 pin 0 stopped 0.0") &&
                                      Catch::Contains(" short of its target (vertex 44), blocked by cloth"));
}

TEST_CASE("Jumps of loads, materials and limits leave a feasible state", "[physics]") {
  Stepped s(R"(
name: jumps
cloth: {shape: square, side: 0.4, columns: 10, rows: 10}
levels: 2
start: {perturbation: 1e-3}
pins: [{region: nearest, point: [0, 0, 0]}, {region: nearest, point: [0.4, 0, 0]}]
energies: [neo_hookean, hinge, gravity, {type: strain_limit, limit: 1.2}]
contact: ipc
schedule:
  steps: 6
  equilibrate: true
  keys:
    - {parameter: energies.gravity.acceleration, interpolation: step, times: [0, 1, 2], values: [[0, 0, -9.81], [0, 0, -981], [0, 0, -9.81]]}
    - {parameter: material.membrane_modulus, interpolation: step, times: [0, 3], values: [8e4, 80]}
    - {parameter: material.bending_modulus, interpolation: step, times: [0, 3], values: [8e4, 80]}
    - {parameter: energies.strain_limit.limit, interpolation: step, times: [0, 4], values: [1.2, 1.05]}
    - {parameter: material.thickness, interpolation: step, times: [0, 5], values: [3e-4, 1e-3]}
    - {parameter: material.density, interpolation: step, times: [0, 6], values: [470, 100]}
methods: {pcs: {}}
)");
  for (const LevelResult& level : s.levels) {
    INFO(level.message);
    CHECK(level.outcome == Outcome::converged);
  }
  CHECK(s.intersections == 0);
  REQUIRE(s.rows.size() == 8);  // of level 0, and the last ones of level 1
  CHECK(s.model().material().density == 100);
  const auto& limit = *s.model().limits()[0]->stretch_limit();
  CHECK(limit.limit() == 1.05);
  CHECK(limit.violations(s.x()).empty());
}

TEST_CASE("A rising floor lifts a cloth, and a closing lid is stopped", "[physics]") {
  const auto scene = [](const std::string& keys) {
    return R"(
name: lifted
cloth: {shape: square, side: 0.3, columns: 10, rows: 10}
levels: 1
start: {translate: [-0.15, -0.15, 0.05], perturbation: 1e-4}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles:
  - {name: plate, meshed_shape: box, size: [0.4, 0.4, 0.01], translate: [0, 0, 0.04]}
  - {name: lid, shape: box, size: [0.4, 0.4, 0.01], translate: [0, 0, 0.5], friction: 0}
friction: 0.3
schedule:
  steps: 10
  keys: [)" +
           keys + R"(]
methods: {newton: {}}
)";
  };
  const Stepped s(
      scene("{parameter: obstacles.plate.translate, times: [0, 1], values: [[0, 0, 0.04], [0.05, 0, "
            "0.24]]}"));
  INFO(s.levels[0].message);
  REQUIRE(s.levels[0].outcome == Outcome::converged);
  CHECK(s.intersections == 0);
  const Eigen::RowVector3d centroid = s.x().colwise().mean();
  CHECK(centroid.z() == Approx(0.245).margin(1.5e-3));
  // Friction drags it sideways too, except for what slid while it was lifted off the start.
  CHECK(centroid.x() > 0.03);

  const Stepped closing(
      scene("{parameter: obstacles.lid.translate, times: [0, 1], values: [[0, 0, 0.5], [0, 0, 0.045]]}"));
  CHECK(closing.levels[0].outcome == Outcome::infeasible);
  CHECK_THAT(closing.levels[0].message,
             Catch::Contains("cannot be completed") && Catch::Contains("lid: box"));
  CHECK(closing.intersections == 0);
}

TEST_CASE("An obstacle whose target touches held cloth is named, and soon") {
  for (const std::string plate : {"shape: box, size", "meshed_shape: box, size"}) {
    INFO(plate);
    Stepped s(R"(name: touched
cloth: {shape: square, side: 0.2, columns: 8, rows: 8}
levels: 1
energies: [neo_hookean, hinge, gravity]
pins:
  - {region: nearest, point: [0, 0, 0]}
  - {region: nearest, point: [0.2, 0, 0]}
  - {region: nearest, point: [0, 0.2, 0]}
  - {region: nearest, point: [0.2, 0.2, 0]}
contact: [{type: ipc, self_contact: false}, shapes]
obstacles: [{name: plate, )" +
              plate + R"(: [1, 1, 0.1], translate: [0, 0, -0.2]}]
methods: {newton: {newton: {max_steps: 500}}}
schedule:
  steps: 4
  equilibrate: true
  keys: [{parameter: obstacles.plate.translate, times: [0, 1], values: [[0, 0, -0.2], [0, 0, -0.05]]}]
)");
    CHECK(s.levels[0].outcome == Outcome::infeasible);
    CHECK_THAT(s.levels[0].message,
               Catch::Contains("the increment to pseudo-time 1 cannot be completed") &&
                   Catch::Contains("plate") &&
                   Catch::EndsWith(" m: at its target the obstacle touches or crosses the cloth"));
    CHECK(s.intersections == 0);
  }
}
