#include <map>

#include "core/numerics/model/stretch_limit.h"
#include "tests/support/stepped.h"
#include "tests/support/strip.h"

using namespace drape;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

/// A square above a ball, of which one pin is moved down onto it, and back up in the second half of the steps
/// if asked for.
std::string dragged_onto_a_ball(int levels, int steps, bool and_back = false) {
  return filled(R"(name: dragged
cloth: {shape: square, side: 0.5, columns: 10, rows: 10}
start: {translate: [-0.25, -0.25, 0.22]}
pins:
  - {region: nearest, point: [0.222, 0.222, 0], translate: [-0.25, -0.25, 0.22]}
  - {region: nearest, point: [0, 0, 0]}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{name: ball, shape: sphere, radius: 0.2}]
methods: {pcs: {}}
levels: $
schedule:
  steps: $
  keys: [{parameter: pins.0.translate, times: [0, 1$], values: [[-0.25, -0.25, 0.22], [-0.25, -0.25, 0.1]$]}]
)",
                levels, steps, and_back ? ", 2" : "", and_back ? ", [-0.25, -0.25, 0.22]" : "");
}

/// Items of pins or handles at the corners of a square of 0.2 m.
std::string at_corners(const std::string& keys) {
  std::string all;
  for (const char* place : {"0, 0", "0.2, 0", "0, 0.2", "0.2, 0.2"})
    all += filled("{region: nearest, point: [$, 0]$}, ", place, keys);
  return "[" + all + "]";
}

void require_converged(const Stepped& s, std::size_t rows) {
  INFO(s.levels[0].message);
  REQUIRE(s.levels[0].outcome == Outcome::converged);
  REQUIRE(s.rows.size() == rows);
}

}  // namespace

TEST_CASE("A strip that is lifted by its end while its weight grows follows the cantilever's tables") {
  BeamStrip strip(40);
  strip.stiffness = strip.weight();  // Γ = 1 under full weight
  Stepped s(strip.yaml("hinge, gravity", newton_to(1e-4) + R"(schedule:
  steps: 6
  equilibrate: true
  keys:
    - {parameter: energies.gravity.acceleration, times: [0, 3, 4, 5, 6], interpolation: linear,
       values: [[0, 0, -0.981], [0, 0, -9.81], [0, 0, -49.05], [0, 0, -196.2], [0, 0, -981]]}
    - {parameter: pins.0.translate, times: [0, 6], values: [[0, 0, 0], [0.3, -0.2, 0.9]]}
)"));
  require_converged(s, 7);
  table("Tip angle [degrees] of a cantilever that is moved while its weight grows", "gamma", "hinge",
        "exact");
  for (const auto& [increment, gamma] : std::map<int, double>{{0, 0.1}, {3, 1}, {4, 5}, {5, 20}, {6, 100}}) {
    s.levels[0].x = s.states[increment];
    row(gamma, tip_angle(s), tip_under_weight(gamma));
    CHECK(std::abs(tip_angle(s) - tip_under_weight(gamma)) < 0.02);
    // The clamp reaches its target exactly.
    const Eigen::RowVector3d moved = Eigen::RowVector3d(0.3, -0.2, 0.9) * (increment / 6.0);
    CHECK((s.x().row(0) - s.rest().row(0) - moved).norm() < 1e-15);
  }
}

TEST_CASE("A ribbon that is slowly twisted and untwisted recovers its energy") {
  const Stepped s(experiment(R"(
cloth: {shape: rectangle, size: [0.4, 0.05], triangulation: criss_cross, columns: 33, rows: 5}
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
  keys: [{parameter: pins.1.rotate, times: [0, 1, 2], values: [[0, 0, 0], [60, 0, 0], [0, 0, 0]]}]
)"));
  require_converged(s, 13);
  for (std::size_t k = 0; k < 7; ++k) {
    const double there = s.rows[k].energy, back = s.rows[12 - k].energy;
    CHECK(std::abs(back - there) < (k == 0 ? 1e-5 : 1e-4) * std::abs(there));
  }
  const double before = s.rows[0].energy;
  CHECK(std::abs(s.rows[6].energy - before) > 0.1 * std::abs(before));
}

TEST_CASE("Handles carry the weight by their displacement") {
  for (const int levels : {1, 2}) {
    const Stepped s(filled(R"(name: carried
cloth: {shape: square, side: 0.2, columns: 9, rows: 9}
levels: $
handles: $
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-7}
methods: {pcs: {}}
)",
                           levels, at_corners(", stiffness: 2000")));
    REQUIRE(s.levels.back().outcome == Outcome::converged);
    const double area_density = s.model().material().area_density();
    double pull = 0;
    for (const int v : {0, 8, 72, 80})
      pull +=
          2000 * area_density * s.scene->hierarchy.levels[0].vertex_area[v] * (s.rest()(v, 2) - s.x()(v, 2));
    CHECK(pull == Approx(9.81 * area_density * 0.04).epsilon(1e-6));
  }
}

TEST_CASE("A pin that is dragged into an obstacle stops there and is named") {
  const Stepped s(dragged_onto_a_ball(2, 3));
  REQUIRE(s.levels.size() == 2);
  for (const LevelResult& level : s.levels) {
    CHECK(level.outcome == Outcome::infeasible);
    CHECK_THAT(level.message, StartsWith(std::string(level.level == 0 ? "at pseudo-time 0.333 " : "") +
                                         "pin 0 stopped 0.0") &&
                                  Contains(" short of its target (vertex 44), blocked by cloth triangle ") &&
                                  EndsWith("and ball: sphere; the rest of the cloth is at equilibrium"));
    CHECK(level.force_residual <= 1e-3);
    const double above = level.x.row(44).norm() - 0.2;
    CHECK(above > 0);
    CHECK(above < 1e-3);
  }
  CHECK(s.intersections == 0);
}

TEST_CASE("A pin that stopped short is named where the level ends without equilibrium, or goes on") {
  const std::string scene = dragged_onto_a_ball(1, 1);
  // Short steps approach the equilibrium slowly, after the target has been found infeasible.
  const auto with_steps = [&](int steps) {
    return Stepped(
        scene +
        filled("newton: {step_size: 0.02, step_growth: 1, force_tolerance: 1e-6, max_steps: $}\n", steps));
  };
  const Stepped whole = with_steps(5000);
  REQUIRE(whole.levels[0].outcome == Outcome::infeasible);
  REQUIRE(!whole.rows.empty());
  const LevelResult cut = with_steps(whole.rows.back().steps - 1).levels[0];
  CHECK(cut.outcome == Outcome::max_steps_reached);
  CHECK_THAT(cut.message,
             StartsWith("no equilibrium within max_steps = ") && Contains("; pin 0 stopped 0.0"));

  const LevelResult went_on = Stepped(dragged_onto_a_ball(1, 4, true)).levels.at(0);
  CHECK(went_on.outcome == Outcome::converged);
  CHECK_THAT(went_on.message, StartsWith("at pseudo-time 0.5 pin 0 stopped 0.0"));
}

TEST_CASE("Jumps of loads, materials and limits leave a feasible state") {
  const Stepped s(R"(name: jumps
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
    - {parameter: energies.gravity.acceleration, interpolation: step, times: [0, 1, 2],
       values: [[0, 0, -9.81], [0, 0, -981], [0, 0, -9.81]]}
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

TEST_CASE("A rising floor lifts a cloth, and a closing lid is stopped") {
  const auto moved = [](const std::string& obstacle, const std::string& from, const std::string& to) {
    return experiment(R"(
cloth: {shape: square, side: 0.3, columns: 10, rows: 10}
start: {translate: [-0.15, -0.15, 0.05], perturbation: 1e-4}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles:
  - {name: plate, meshed_shape: box, size: [0.4, 0.4, 0.01], translate: [0, 0, 0.04]}
  - {name: lid, shape: box, size: [0.4, 0.4, 0.01], translate: [0, 0, 0.5], friction: 0}
friction: 0.3
schedule: {steps: 10, keys: [{parameter: obstacles.$.translate, times: [0, 1], values: [$, $]}]}
)",
                      obstacle, from, to);
  };
  const Stepped lifted(moved("plate", "[0, 0, 0.04]", "[0.05, 0, 0.24]"));
  INFO(lifted.levels[0].message);
  REQUIRE(lifted.levels[0].outcome == Outcome::converged);
  CHECK(lifted.intersections == 0);
  const Eigen::RowVector3d centroid = lifted.x().colwise().mean();
  CHECK(centroid.z() == Approx(0.245).margin(1.5e-3));
  // Friction drags it sideways too, except for what slid while it was lifted off the start.
  CHECK(centroid.x() > 0.03);

  const Stepped closing(moved("lid", "[0, 0, 0.5]", "[0, 0, 0.045]"));
  CHECK(closing.levels[0].outcome == Outcome::infeasible);
  CHECK_THAT(closing.levels[0].message, Contains("cannot be completed") && Contains("lid: box"));
  CHECK(closing.intersections == 0);
}

TEST_CASE("An obstacle whose target touches held cloth is named, and soon") {
  for (const char* shape : {"shape", "meshed_shape"}) {
    INFO(shape);
    const Stepped s(experiment(R"(
cloth: {shape: square, side: 0.2, columns: 8, rows: 8}
energies: [neo_hookean, hinge, gravity]
pins: $
contact: [{type: ipc, self_contact: false}, shapes]
obstacles: [{name: plate, $: box, size: [1, 1, 0.1], translate: [0, 0, -0.2]}]
newton: {max_steps: 500}
schedule:
  steps: 4
  equilibrate: true
  keys: [{parameter: obstacles.plate.translate, times: [0, 1], values: [[0, 0, -0.2], [0, 0, -0.05]]}]
)",
                               at_corners(""), shape));
    CHECK(s.levels[0].outcome == Outcome::infeasible);
    CHECK_THAT(s.levels[0].message, Contains("increment to pseudo-time 1 cannot be completed") &&
                                        Contains("plate") &&
                                        EndsWith("at its target the obstacle touches or crosses the cloth"));
    CHECK(s.intersections == 0);
  }
}
