// When a level ends: scenes in which a rule for it once ended one too early, or never.

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "core/kernel/files/message_text.h"
#include "core/numerics/model/objective.h"
#include "core/numerics/solve/newton.h"
#include "core/numerics/solve/newton_state.h"
#include "tests/support/solve.h"
#include "tests/unit/solve/resumed.h"

using namespace drape;

namespace {

/// Counts the iterations that left the cloth where it was.
struct Standstills : Observer {
  Positions last;
  int count = 0;
  void iteration(const IterationRow&, const Positions& x) override {
    count += last.rows() == x.rows() && last == x;
    last = x;
  }
};

LevelResult first_level(const Solved& s, Observer& observer) {
  return s.experiment.methods[0].second->solve(*s.scene, observer)[0];
}

/// An experiment of one level and these keys.
std::string one_level(const std::string& keys) {
  return "name: scene\nlevels: 1\nmethods: {newton: {}}\n" + keys;
}

/// A strip that hangs steeply from its upper end and is taut, since the floor drags its lower end away: the
/// friction on that end lifts it by more than its normal force changes friction.
std::string dragged_strip(const std::string& newton) {
  return one_level(R"(
cloth: {shape: rectangle, size: [0.2, 0.04], columns: 11, rows: 3, triangulation: one_way}
start: {rotate: [0, 80, 0], translate: [0, 0, 0.197562]}
pins: [{region: box, lower: [-0.001, -1, -1], upper: [0.001, 1, 1]}]
energies: [neo_hookean, hinge, gravity]
contact: shapes
obstacles: [{name: floor, shape: half_space}]
friction: 1.5
newton: {)" + newton +
                   R"(}
schedule:
  steps: 4
  keys: [{parameter: obstacles.floor.translate, times: [0, 1], values: [[0, 0, 0], [0.1, 0, 0]]}]
)");
}

}  // namespace

TEST_CASE("A level that lands within one long step is converged with the friction of where it lands") {
  const Solved s = scene_from(one_level(R"(
cloth: {shape: rectangle, size: [0.3, 0.1], triangulation: one_way, vertices: 60}
material: {thickness: 3e-4, membrane_modulus: 1e5, bending_modulus: 1e5}
start: {translate: [0, 0, 0.002]}
pins: [{region: box, lower: [-0.001, -1, -1], upper: [0.001, 1, 1]}]
energies: [neo_hookean, hinge, {type: gravity, acceleration: [3, 0, -9.81]}]
contact: {type: shapes, dhat: 0.001}
obstacles: [{name: floor, shape: half_space}]
friction: 0.5
newton: {step_size: 1, iterations_per_step: 30}
)"));
  PlainObjective objective(s.model());
  Observer silent;
  const LevelResult r =
      minimise(objective, s.scene->starts[0], s.experiment.parameters.newton, {Stopwatch(), silent});
  REQUIRE(r.outcome == Outcome::converged);
  Positions g;
  objective.contacts().update_lagging(r.x);
  objective.gradient(r.x, g);
  CHECK(free_norm(g, s.model().fixed()) / s.model().residual_scale(r.x, g) <= 1e-3);
}

TEST_CASE("A tolerance that leaves convergence to the decrement lets no failed search pass for a step") {
  const Solved s = scene_from(one_level(R"(
cloth: {shape: rectangle, size: [0.2, 0.2], triangulation: one_way, vertices: 121}
start: {translate: [-0.1, -0.1, 0.0515], perturbation: 1e-4}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.0608}, gravity]
contact: ipc
obstacles: [{name: post, meshed_shape: sphere, subdivisions: 3, radius: 0.05}]
friction: 0.1
newton: {form: static, force_tolerance: 1e6, decrement_tolerance: 1e-2, max_steps: 100}
)"));
  Standstills observer;
  first_level(s, observer);
  CHECK(observer.count <= 3);
}

TEST_CASE("A pin that the penalty pulls is not given up before the cloth has followed") {
  converged(solve_yaml(one_level(R"(
cloth: {shape: rectangle, size: [0.2, 0.1], triangulation: one_way, vertices: 66}
start: {translate: [-0.1, -0.05, 0.0015]}
pins:
  - {region: box, lower: [-1, -1, -1], upper: [0.0001, 1, 1], translate: [-0.1, -0.05, 0.0015]}
  - {region: box, lower: [0.1999, -1, -1], upper: [1, 1, 1], translate: [-0.1, -0.05, 0.0015]}
energies: [neo_hookean, hinge, gravity]
contact: shapes
obstacles: [{name: post, shape: sphere, radius: 0.03, translate: [0, 0, -0.03]}]
newton: {psd_blend: full, step_growth: 1, force_tolerance: 1e6, decrement_tolerance: 1e-2}
schedule:
  steps: 1
  equilibrate: true
  keys:
    - {parameter: pins.0.translate, times: [0, 1], values: [[-0.1, -0.05, 0.0015], [-0.05, -0.05, -0.05]]}
    - {parameter: pins.1.translate, times: [0, 1], values: [[-0.1, -0.05, 0.0015], [-0.15, -0.05, -0.05]]}
)")));
}

TEST_CASE("A cloth that its pins carry far in one increment does not drift") {
  converged(solve_yaml(one_level(R"(
cloth: {shape: rectangle, size: [0.01, 0.01], triangulation: one_way, vertices: 25}
pins: [{region: ball, point: [0, 0, 0], radius: 0.003, translate: [0, 0, 0]}]
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-4}
schedule:
  steps: 1
  keys: [{parameter: pins.0.translate, times: [0, 1], values: [[0, 0, 0], [2, 0, 0]]}]
)")));
}

TEST_CASE("Friction whose normal forces answer it more than they change it comes to rest") {
  for (const std::string newton :
       {"step_growth: 1.5", "step_growth: 1, step_size: 1", "iterations_per_step: 10"}) {
    const LevelResult r = solve_yaml(dragged_strip(newton)).levels[0];
    INFO(newton << ": " << r.steps << " steps, " << r.message);
    CHECK(r.outcome == Outcome::converged);
    CHECK(r.steps < 150);
  }
}

TEST_CASE("A level whose friction was damped is resumed bit for bit") {
  KeepingObserver whole;
  whole.keeps_states = true;
  const Solved s = scene_from(dragged_strip("step_growth: 1.5"));
  const LevelResult expected = first_level(s, whole);
  REQUIRE(expected.outcome == Outcome::converged);
  const auto is_damped = [](const NewtonState& state) { return state.contacts.damping.fraction < 1; };
  CHECK(std::ranges::count_if(whole.states, is_damped) > 3);
  std::erase_if(whole.states,
                [&](const NewtonState& state) { return !is_damped(state) && state.check.cycle.steps < 12; });
  check_resumed(whole, expected, [&](const NewtonState& state, Observer& observer) {
    const Solved again = scene_from(dragged_strip("step_growth: 1.5"));
    MethodState from;
    from.under_way = state;
    return s.experiment.methods[0].second->resume(*again.scene, from, observer)[0];
  });
}

TEST_CASE("A level that ends at max_steps tells its force residual and whether that still falls") {
  int falling = 0, risen = 0;
  for (int max_steps = 10; max_steps < 40; ++max_steps) {
    KeepingObserver kept;
    const LevelResult r =
        first_level(scene_from(dragged_strip("max_steps: " + std::to_string(max_steps))), kept);
    INFO(r.message);
    CHECK(kept.rows.back().force_residual == r.force_residual);
    if (r.outcome != Outcome::max_steps_reached) continue;
    CHECK_THAT(r.message, Catch::Contains("force residual " + three_digits(r.force_residual)));
    std::map<int, double> at_end;  // force residual of each step
    for (const IterationRow& row : kept.rows) at_end[row.step] = row.force_residual;
    const auto lowest =
        std::ranges::min_element(at_end, {}, [](const auto& of_step) { return of_step.second; });
    const int since = at_end.rbegin()->first - lowest->first;
    const bool falls = since < 0.1 * max_steps;
    ++(falls ? falling : risen);
    CHECK_THAT(r.message, Catch::EndsWith(falls ? ", which still falls: raise max_steps"
                                                : ", which was lowest " + std::to_string(since) +
                                                      " steps before, at " + three_digits(lowest->second) +
                                                      ": more steps are unlikely to help"));
  }
  CHECK(falling + risen > 10);
  CHECK(risen > 0);
}

TEST_CASE("A level that goes on from one that nothing held is not called converged") {
  const Solved s = solve_yaml(R"(
name: far_away
cloth: {shape: square, side: 0.01, vertices: 25}
levels: 2
energies:
  - neo_hookean
  - hinge
  - {type: formula, name: well, per: vertex, constants: {k: {value: 100, unit: N/m^3},
     far: {value: 2, unit: m}}, energy: "k*area*((x-far)^2 + y^2 + z^2)/2"}
methods: {cascadic: {}}
)");
  REQUIRE(s.levels.size() == 2);
  REQUIRE(s.levels[0].outcome == Outcome::infeasible);  // a distance of 141 diagonals
  INFO(s.levels[1].message);
  CHECK(s.levels[1].force_residual < 1e-3);  // it is at equilibrium where the other level had come to
  CHECK(s.levels[1].outcome == Outcome::infeasible);
  CHECK(s.levels[1].message == "at equilibrium, but it began from level 0, which had come to no end");
}
TEST_CASE("An equilibrium whose Hessian cannot be judged says that its stability was not tested") {
  const auto ended = [](const std::string& stability) {
    const Solved s = solve_yaml(R"(
name: infinitely_stiff
cloth: {shape: square, side: 1, vertices: 25}
levels: 1
energies:
  - neo_hookean
  - hinge
  - {type: formula, name: cusp, per: vertex, constants: {k: {value: 1, unit: N/m},
     unit: {value: 1, unit: m}}, energy: "k*area*abs(z/unit)^1.5"}
methods: {newton: {newton: {stability: )" +
                                stability + "}}}\n");
    REQUIRE(s.levels.size() == 1);
    REQUIRE(s.levels[0].outcome == Outcome::converged);
    CHECK_FALSE(s.levels[0].stability);
    CHECK(std::string(stability_word(s.levels[0])) == "untested");
    return s.levels[0].message;
  };
  CHECK(ended("leave") == "stability not tested: the Hessian is not finite");
  CHECK(ended("off").empty());
}
