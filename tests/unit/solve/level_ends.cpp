// When a level ends: scenes in which a rule for it once ended one too early, or never.

#include <catch2/catch.hpp>

#include "core/kernel/files/message_text.h"
#include "core/numerics/model/objective.h"
#include "core/numerics/solve/newton.h"
#include "core/numerics/solve/newton_state.h"
#include "tests/support/keeping_observer.h"
#include "tests/support/solve.h"

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

/// A strip that hangs steeply from its upper end and is taut, since the floor drags its lower end away: the
/// friction on that end lifts it by more than its normal force changes friction.
std::string dragged_strip(const std::string& newton) {
  return R"(
name: drag
cloth: {shape: rectangle, size: [0.2, 0.04], columns: 11, rows: 3, triangulation: one_way}
levels: 1
material: {}
start: {rotate: [0, 80, 0], translate: [0, 0, 0.197562]}
pins: [{region: box, lower: [-0.001, -1, -1], upper: [0.001, 1, 1]}]
energies: [neo_hookean, hinge, gravity]
contact: shapes
obstacles: [{name: floor, shape: half_space}]
friction: 1.5
newton: {)" +
         newton + R"(}
schedule:
  steps: 4
  keys:
    - {parameter: obstacles.floor.translate, times: [0, 1], values: [[0, 0, 0], [0.1, 0, 0]]}
methods: {newton: {}}
)";
}

}  // namespace

TEST_CASE("A level that lands within one long step is converged with the friction of where it lands") {
  const Solved s = scene_from(R"(
name: strip
cloth: {shape: rectangle, size: [0.3, 0.1], triangulation: one_way, vertices: 60}
levels: 1
material: {thickness: 3e-4, membrane_modulus: 1e5, bending_modulus: 1e5}
start: {translate: [0, 0, 0.002]}
pins: [{region: box, lower: [-0.001, -1, -1], upper: [0.001, 1, 1]}]
energies: [neo_hookean, hinge, {type: gravity, acceleration: [3, 0, -9.81]}]
contact: {type: shapes, dhat: 0.001}
obstacles: [{name: floor, shape: half_space}]
friction: 0.5
newton: {step_size: 1, iterations_per_step: 30}
methods: {newton: {}}
)");
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
  Solved s = scene_from(R"(
name: sphere
cloth: {shape: rectangle, size: [0.2, 0.2], triangulation: one_way, vertices: 121}
levels: 1
start: {translate: [-0.1, -0.1, 0.0515], perturbation: 1e-4}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.0608}, gravity]
contact: ipc
obstacles: [{name: post, meshed_shape: sphere, subdivisions: 3, radius: 0.05}]
friction: 0.1
newton: {form: static, force_tolerance: 1e6, decrement_tolerance: 1e-2, max_steps: 100}
methods: {newton: {}}
)");
  Standstills observer;
  s.levels = s.experiment.methods[0].second->solve(*s.scene, observer);
  CHECK(observer.count <= 3);
}

TEST_CASE("A pin that the penalty pulls is not given up before the cloth has followed") {
  converged(solve_yaml(R"(
name: wrapped
cloth: {shape: rectangle, size: [0.2, 0.1], triangulation: one_way, vertices: 66}
levels: 1
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
methods: {newton: {}}
)"));
}

TEST_CASE("A cloth that its pins carry far in one increment does not drift") {
  converged(solve_yaml(R"(
name: far
cloth: {shape: rectangle, size: [0.01, 0.01], triangulation: one_way, vertices: 25}
levels: 1
pins: [{region: ball, point: [0, 0, 0], radius: 0.003, translate: [0, 0, 0]}]
energies: [neo_hookean, hinge, gravity]
newton: {force_tolerance: 1e-4}
schedule:
  steps: 1
  keys:
    - {parameter: pins.0.translate, times: [0, 1], values: [[0, 0, 0], [2, 0, 0]]}
methods: {newton: {}}
)"));
}

TEST_CASE("Friction whose normal forces answer it more than they change it comes to rest") {
  for (const std::string newton :
       {"step_growth: 1.5", "step_growth: 1, step_size: 1", "iterations_per_step: 10"}) {
    const Solved s = solve_yaml(dragged_strip(newton));
    INFO(newton << ": " << s.levels[0].steps << " steps, " << s.levels[0].message);
    CHECK(s.levels[0].outcome == Outcome::converged);
    CHECK(s.levels[0].steps < 150);
  }
}

TEST_CASE("A level whose friction was damped is resumed bit for bit") {
  Solved s = scene_from(dragged_strip("step_growth: 1.5"));
  KeepingObserver whole;
  whole.keeps_states = true;
  const Solver& solver = *s.experiment.methods[0].second;
  const LevelResult expected = solver.solve(*s.scene, whole)[0];
  REQUIRE(expected.outcome == Outcome::converged);
  int damped = 0;
  for (const NewtonState& state : whole.states) {
    if (state.contacts.damping.fraction == 1 && state.check.cycle.steps < 12) continue;
    damped += state.contacts.damping.fraction < 1;
    Solved again = scene_from(dragged_strip("step_growth: 1.5"));
    Observer silent;
    MethodState from;
    from.under_way = state;
    const LevelResult r = solver.resume(*again.scene, from, silent)[0];
    CHECK(r.steps == expected.steps);
    CHECK(r.x == expected.x);
    CHECK(r.force_residual == expected.force_residual);
  }
  CHECK(damped > 3);
}

TEST_CASE("A level that ends at max_steps tells its force residual and whether that still falls") {
  int checked = 0, rose = 0;
  for (int max_steps = 10; max_steps < 40; ++max_steps) {
    Solved s = scene_from(dragged_strip("max_steps: " + std::to_string(max_steps)));
    KeepingObserver kept;
    const LevelResult r = s.experiment.methods[0].second->solve(*s.scene, kept)[0];
    INFO(r.message);
    CHECK(kept.rows.back().force_residual == r.force_residual);
    if (r.outcome != Outcome::max_steps_reached) continue;
    ++checked;
    CHECK_THAT(r.message, Catch::Contains("force residual " + three_digits(kept.rows.back().force_residual)));
    const IterationRow* lowest = nullptr;
    for (std::size_t i = 0; i < kept.rows.size(); ++i) {
      const bool ends_step = i + 1 == kept.rows.size() || kept.rows[i + 1].step != kept.rows[i].step;
      if (ends_step && (!lowest || kept.rows[i].force_residual < lowest->force_residual))
        lowest = &kept.rows[i];
    }
    const int steps_since = kept.rows.back().step - lowest->step;
    const bool falls = steps_since < 0.1 * max_steps;
    rose += !falls;
    CHECK_THAT(r.message,
               Catch::EndsWith(falls ? ", which still falls: raise max_steps"
                                     : ", which was " + three_digits(lowest->force_residual) + " " +
                                           std::to_string(steps_since) +
                                           " steps before and has not been lower since: more steps are "
                                           "unlikely to help"));
  }
  CHECK(checked > 10);
  CHECK(rose > 0);
}
