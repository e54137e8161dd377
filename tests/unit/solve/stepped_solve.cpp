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

/// A solver that fails in its second iteration and cannot be resumed.
struct Failing : Solver {
  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const override {
    observer.level_started(0);
    observer.iteration({}, problem.starts[0]);
    throw std::runtime_error("out of luck");
  }
};

}  // namespace

TEST_CASE("a stepped solve shows every iteration and ends with the bits of a plain one, resumed too") {
  const Solved plain = scene_from(small_experiment());
  KeepingObserver observer;
  const std::vector<LevelResult> expected = plain.experiment.solver_of("pcs").solve(*plain.scene, observer);
  Stepped whole("pcs");
  std::vector<MethodState> checkpoints;
  std::size_t k = 0;
  for (; whole.solve.advance(); ++k) {
    CHECK(whole.solve.row().force_residual == observer.rows.at(k).force_residual);
    CHECK(whole.solve.x().rows() == whole.scene->hierarchy.levels[whole.solve.row().level].vertex_count());
    if (k == 2 || k + 2 == observer.rows.size()) checkpoints.push_back(whole.solve.checkpoint());
  }
  CHECK(whole.solve.ended());
  CHECK_FALSE(whole.solve.advance());
  CHECK(k == observer.rows.size());
  const auto check_results = [&](const std::vector<LevelResult>& results) {
    REQUIRE(results.size() == expected.size());
    for (std::size_t l = 0; l < expected.size(); ++l) {
      CHECK(results[l].outcome == expected[l].outcome);
      CHECK(results[l].x == expected[l].x);
    }
  };
  check_results(whole.solve.finished());
  for (const MethodState& checkpoint : checkpoints) {
    Stepped resumed("pcs", checkpoint);
    while (resumed.solve.advance()) continue;
    check_results(resumed.solve.finished());
  }
}

TEST_CASE("a stepped solve is stopped, refined or left at any iteration") {
  Stepped stopped("newton"), refined("pcs");
  REQUIRE(stopped.solve.advance());
  stopped.solve.stop();
  CHECK_FALSE(stopped.solve.advance());
  REQUIRE(stopped.solve.finished().size() == 1);
  CHECK(stopped.solve.finished()[0].outcome == Outcome::cancelled);

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
