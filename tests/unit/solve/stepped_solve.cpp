#include "core/numerics/solve/stepped_solve.h"

#include <catch2/catch.hpp>

#include "tests/support/keeping_observer.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// A method of the small experiment, advanced step by step.
struct Stepped : Solved {
  explicit Stepped(const std::string& method, MethodState from = {})
      : Solved(scene_from(small_experiment())),
        solve(experiment.solver_of(method), *scene, std::move(from)) {}

  SteppedSolve solve;
};

/// What Solver::solve gives.
std::vector<LevelResult> solved(const std::string& method, KeepingObserver& observer) {
  const Solved fresh = scene_from(small_experiment());
  return fresh.experiment.solver_of(method).solve(*fresh.scene, observer);
}

/// A solver that fails in its second iteration and cannot be resumed.
struct Failing : Solver {
  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const override {
    observer.level_started(0);
    observer.iteration({}, problem.starts[0]);
    throw std::runtime_error("out of luck");
  }
};

}  // namespace

TEST_CASE("a stepped solve shows every iteration and ends with the bits of a plain one") {
  for (const char* method : {"pcs", "newton"}) {
    KeepingObserver plain;
    const std::vector<LevelResult> expected = solved(method, plain);
    Stepped stepped(method);
    SteppedSolve& solve = stepped.solve;
    std::size_t k = 0;
    for (; solve.advance(); ++k) {
      CHECK(solve.row().force_residual == plain.rows.at(k).force_residual);
      CHECK(solve.x().rows() == stepped.scene->hierarchy.levels[solve.row().level].vertex_count());
    }
    CHECK(solve.ended());
    CHECK_FALSE(solve.advance());
    CHECK(k == plain.rows.size());
    REQUIRE(solve.finished().size() == expected.size());
    for (std::size_t l = 0; l < expected.size(); ++l) {
      CHECK(solve.finished()[l].outcome == expected[l].outcome);
      CHECK(solve.finished()[l].x == expected[l].x);
    }
  }
}

TEST_CASE("a checkpoint of a stepped solve is resumed to the same bits") {
  KeepingObserver plain;
  const std::vector<LevelResult> expected = solved("pcs", plain);
  for (const int steps : {1, 3, static_cast<int>(plain.rows.size()) - 1}) {
    Stepped first("pcs");
    for (int k = 0; k < steps; ++k) REQUIRE(first.solve.advance());
    const MethodState checkpoint = first.solve.checkpoint();
    Stepped resumed("pcs", checkpoint);
    while (resumed.solve.advance()) continue;
    REQUIRE(resumed.solve.finished().size() == expected.size());
    CHECK(resumed.solve.finished().back().x == expected.back().x);
  }
}

TEST_CASE("a stepped solve is stopped, refined or left at any iteration") {
  Stepped stopped("newton");
  REQUIRE(stopped.solve.advance());
  stopped.solve.stop();
  CHECK_FALSE(stopped.solve.advance());
  REQUIRE(stopped.solve.finished().size() == 1);
  CHECK(stopped.solve.finished()[0].outcome == Outcome::cancelled);

  Stepped refined("pcs");
  REQUIRE(refined.solve.advance());
  refined.solve.refine();
  REQUIRE(refined.solve.advance());
  CHECK(refined.solve.row().level == 1);
  CHECK(refined.solve.finished()[0].outcome == Outcome::refined_early_on_request);
  // Both destructors are called here, that of the second in the middle of its solve.
}

TEST_CASE("what a solver throws is thrown to the caller, and only what resumes takes a state") {
  const Solved any = scene_from(small_experiment());
  const Failing failing;
  SteppedSolve solve(failing, *any.scene);
  REQUIRE(solve.advance());
  CHECK_THROWS_WITH(solve.advance(), "out of luck");
  CHECK_FALSE(solve.advance());
  MethodState state;
  state.level = 1;
  CHECK_THROWS_WITH(SteppedSolve(failing, *any.scene, state), Catch::Contains("cannot go on from a state"));
}
