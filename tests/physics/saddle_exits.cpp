// Exits from saddles: their bits, with contact, friction and other factorisations; and what a walk leaves
// behind.

#include <catch2/catch.hpp>

#include "tests/support/any_threads.h"
#include "tests/support/keeping_observer.h"
#include "tests/support/symmetric_scenes.h"

using namespace drape;

namespace {

/// A square in a frame that is too small.
std::string framed(int levels, const std::string& more) {
  return filled("name: scene\nlevels: $\nmethods: {pcs: {}, newton: {}}\n", levels) +
         "cloth: {shape: square, side: 0.1, columns: 15, rows: 15, triangulation: criss_cross}\n"
         "start: {scale: [0.97, 0.97, 1]}\npins: [{region: border}]\nenergies: [neo_hookean, hinge]\n" +
         thin + more;
}

/// Two plates with friction, which the flat square touches on both sides, and on which its folds come to
/// rest.
const std::string plates = R"(contact: {type: shapes, dhat: 0.001}
friction: 0.3
obstacles:
  - {name: floor, shape: half_space, translate: [0, 0, -0.0009]}
  - {name: ceiling, shape: half_space, translate: [0, 0, 0.0009], normal: [0, 0, -1]}
)";

}  // namespace

TEST_CASE("Exits have the same bits on any number of threads, and resume from every step to them") {
  struct Framed {
    std::string name;
    int levels;
    std::string more;
  };
  const std::string cholmod = "newton: {linear_solver: cholmod}\n";
  for (const auto& [name, levels, more] : {Framed{"free", 2, ""},
                                           {"between plates", 1, plates},
                                           {"CHOLMOD", 1, cholmod},
                                           {"both", 1, plates + cholmod}}) {
    INFO(name);
    const Solved s = scene_from(framed(levels, more));
    const Solver& solver = s.experiment.solver_of("newton");
    KeepingObserver whole;
    whole.keeps_states = true;
    const std::vector<LevelResult> expected = solver.solve(*s.scene, whole);
    const LevelResult& last = expected.back();
    REQUIRE(last.outcome == Outcome::converged);
    REQUIRE(last.saddles_left > 0);
    REQUIRE(last.stability);
    CHECK(last.stability->verdict == Stability::stable);
    CHECK(last.smallest_gap.has_value() == (more.find("floor") != std::string::npos));
    if (last.smallest_gap) CHECK(*last.smallest_gap < 5e-4);
    same_with_any_threads([&] {
      Observer silent;
      return solver.solve(*s.scene, silent).back().x;
    });
    int resumed = 0;
    for (const NewtonState& state : whole.states) {
      if (state.so_far.level != last.level) continue;
      MethodState from{{expected.begin(), expected.end() - 1}, last.level, state, 0};
      Observer silent;
      const LevelResult r = solver.resume(*s.scene, from, silent).back();
      REQUIRE(r.x == last.x);
      REQUIRE(r.iterations == last.iterations);
      REQUIRE(r.saddles_left == last.saddles_left);
      ++resumed;
    }
    CHECK(resumed > 1);
  }
}

TEST_CASE("A relaxation of an exit is an iteration, and a report's walk ends once the energy has fallen") {
  const auto rows_of = [](const std::string& mode) {
    const Solved s = scene_from(framed(1, "newton: {stability: " + mode + "}\n"));
    KeepingObserver observer;
    const LevelResult r = s.experiment.solver_of("newton").solve(*s.scene, observer).back();
    CHECK(static_cast<int>(observer.rows.size()) == r.iterations);
    return r.iterations;
  };
  CHECK(rows_of("off") == 0);
  const int reported = rows_of("report");
  CHECK(reported <= 4);  // of one stride
  CHECK(rows_of("leave") > reported);
}

TEST_CASE("A level that is stopped within a walk has no verdict") {
  const Solved s = scene_from(framed(1, ""));
  KeepingObserver observer;
  observer.stop_after = 1;  // a relaxation: the flat square is at equilibrium
  const LevelResult r = s.experiment.solver_of("newton").solve(*s.scene, observer).back();
  CHECK(r.outcome == Outcome::cancelled);
  CHECK_FALSE(r.stability);
  CHECK(largest_entry(r.x.col(2)) == 0);
}

TEST_CASE("Iterations judge a level whose V-cycle cannot be formed") {
  // Folds are 1e-13 as stiff as the membrane, across axes: lost in the single precision of the cycle.
  const Solved s = converged(solve_yaml(R"(name: scene
levels: 2
cloth: {shape: square, side: 0.1, triangulation: criss_cross, columns: 11, rows: 11}
material: {density: 1000, thickness: 1e-7, membrane_modulus: 1e9, bending_modulus: 1e9, poisson_ratio: 0}
start: {rotate: [35, 40, 0]}
pins: [{region: border}]
energies: [neo_hookean, hinge]
newton: {linear_solver: multigrid}
methods: {newton: {}}
)"));
  CHECK(stability_of(s).verdict == Stability::stable);
  CHECK_FALSE(stability_of(s).by_factorisation);
}
