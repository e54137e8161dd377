#include "core/numerics/solve/load_stepper.h"

#include <catch2/catch.hpp>

#include "tests/support/fake_loads.h"
#include "tests/support/newton_problem.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

struct StepperCase : Observer {
  NewtonProblem problem{{energy_of(Wells(NewtonProblem::rest().array() + 0.3, 10, 0))}};
  NewtonParameters parameters;
  EquilibriumCheck check{problem.iterate, parameters};
  NewtonStep step{problem.iterate, check, parameters, [](int) {}, [] { return false; }};
  DirichletEnforcer dirichlet{problem.iterate, step, true};
  FakeLoads loads;
  LoadStepper stepper{&loads, problem.iterate, dirichlet, *this};
  std::vector<IncrementRow> rows;

  explicit StepperCase(double allowed = 1) {
    loads.unchanged = &problem.model;
    loads.allowed = allowed;
  }
  void increment_finished(const IncrementRow& row, const Positions&) override { rows.push_back(row); }

  /// Moves the cloth as a solve to equilibrium would.
  void move(double by) { problem.move_to(problem.iterate.x().array() + by); }
};

}  // namespace

TEST_CASE("Each increment that ends is reported with its own counts") {
  StepperCase c;
  LevelResult& result = c.problem.result;
  result.level = 2, result.steps = 4, result.iterations = 6;
  CHECK(c.stepper.loading());
  CHECK(c.stepper.steps() == 4);
  c.stepper.advance(true);
  CHECK(c.stepper.steps() == 0);
  result.steps += 3, result.iterations += 5;
  c.stepper.advance(true);
  REQUIRE(c.rows.size() == 2);
  const auto counts = [](const IncrementRow& r) {
    return std::vector<int>{r.level, r.increment, r.steps, r.iterations};
  };
  CHECK(counts(c.rows[0]) == std::vector<int>{2, 0, 4, 6});
  CHECK(counts(c.rows[1]) == std::vector<int>{2, 1, 3, 5});
  CHECK(c.rows[1].time == 10);
  CHECK(c.rows[1].energy == c.problem.iterate.energy());
  CHECK(c.rows[1].force_residual == c.problem.iterate.force_residual());
  CHECK(c.stepper.loading());
  c.stepper.advance(true);
  CHECK(!c.stepper.loading());
  CHECK(*c.stepper.time() == 30);
  c.stepper.store_progress(result);
  CHECK(result.load_stepping.increment == 3);
}

TEST_CASE("The rest of an increment takes the cloth along by its response to the first part") {
  StepperCase c(0.4);
  const Positions rest = NewtonProblem::rest();
  c.stepper.advance(true);
  CHECK(c.stepper.state().response.fraction == 0.4);
  CHECK(c.stepper.state().response.from == rest);
  CHECK(c.problem.iterate.limited_by() == "the post");
  CHECK(c.problem.iterate.x() == rest);
  CHECK(c.loads.last == rest);

  c.move(0.02);
  c.stepper.advance(true);
  // 0.4 moved it by 0.02, so the remaining 0.6 by 0.03.
  CHECK((c.problem.iterate.x() - rest).isApproxToConstant(0.05, 1e-9));
  CHECK(c.loads.fractions == std::vector<double>{1});
  CHECK(c.loads.last == c.problem.iterate.x());
  CHECK(c.loads.complete());
  CHECK(c.stepper.state().response.fraction == 0);
  CHECK(!c.stepper.blocked());
}

TEST_CASE("A prediction that equilibrium corrects is trusted less") {
  StepperCase c(0.1);
  c.stepper.advance(true);
  LoadStepper::State state = c.stepper.state();
  // The last prediction moved the cloth by 0.02, and equilibrium by as much again.
  state.response.predicted = NewtonProblem::rest().array() + 0.02;
  c.stepper.restore(state);
  c.move(0.04);
  c.stepper.advance(true);
  // A trust of 1/4: 0.25 · 0.1 / 0.9 of the remainder, then the obstacles alone.
  CHECK(c.loads.fractions.at(0) == Approx(0.25 * 0.1 / 0.9));
  CHECK(c.stepper.state().response.fraction > c.loads.fractions[0]);
}

TEST_CASE("An increment that twenty attempts hardly advance is blocked") {
  StepperCase c(1e-4);
  for (int k = 0; k < 19; ++k) c.stepper.advance(true);
  CHECK(!c.stepper.blocked());

  StepperCase freed(0.5);
  freed.stepper.restore(c.stepper.state());
  freed.stepper.advance(true);
  CHECK(freed.stepper.state().blocked_increments == 0);

  c.stepper.advance(true);
  CHECK(c.stepper.blocked());
  CHECK(c.problem.iterate.limit_text() == "; the step is limited by the post");
  CHECK_THAT(c.stepper.blocked_text(),
             Catch::StartsWith("the increment to pseudo-time 10 cannot be completed; the step is limited by "
                               "the post; if there is room") &&
                 Catch::Contains("raise the schedule's \"steps\""));
}
