#include "core/numerics/solve/load_stepper.h"

#include <catch2/catch.hpp>

#include "tests/support/fake_loads.h"
#include "tests/support/newton_problem.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

struct IncrementRecorder : Observer {
  std::vector<IncrementRow> rows;
  void increment_finished(const IncrementRow& row, const Positions&) override { rows.push_back(row); }
};

struct StepperCase {
  NewtonProblem problem{{energy_of(Wells(NewtonProblem::rest().array() + 0.3, 10, 0))}};
  NewtonParameters parameters;
  EquilibriumCheck check{problem.iterate, parameters};
  NewtonStep step{problem.iterate, check, parameters, [](int) {}, [] { return false; }};
  DirichletEnforcer dirichlet{problem.iterate, step, true};
  FakeLoads loads;
  IncrementRecorder observer;
  LoadStepper stepper{&loads, problem.iterate, dirichlet, observer};

  StepperCase() { loads.unchanged = &problem.model; }

  /// Moves the cloth as a solve to equilibrium would.
  void move(double by) { problem.move_to(problem.iterate.x().array() + by); }
};

}  // namespace

TEST_CASE("Each increment that ends is reported with its own counts") {
  StepperCase c;
  c.problem.result.level = 2;
  c.problem.result.steps = 4;
  c.problem.result.iterations = 6;
  CHECK(c.stepper.loading());
  CHECK(c.stepper.steps() == 4);
  c.stepper.advance(true);
  CHECK(c.stepper.steps() == 0);
  c.problem.result.steps += 3;
  c.problem.result.iterations += 5;
  c.stepper.advance(true);
  REQUIRE(c.observer.rows.size() == 2);
  CHECK(c.observer.rows[0].increment == 0);
  CHECK(c.observer.rows[0].steps == 4);
  CHECK(c.observer.rows[1].level == 2);
  CHECK(c.observer.rows[1].increment == 1);
  CHECK(c.observer.rows[1].time == 10);
  CHECK(c.observer.rows[1].steps == 3);
  CHECK(c.observer.rows[1].iterations == 5);
  CHECK(c.observer.rows[1].energy == c.problem.iterate.energy());
  CHECK(c.observer.rows[1].force_residual == c.problem.iterate.force_residual());
  CHECK(c.stepper.loading());
  c.stepper.advance(true);
  CHECK(!c.stepper.loading());
  CHECK(*c.stepper.time() == 30);
  c.stepper.store_progress(c.problem.result);
  CHECK(c.problem.result.load_stepping.increment == 3);
}

TEST_CASE("The rest of an increment takes the cloth along by its response to the first part") {
  StepperCase c;
  c.loads.allowed = 0.4;
  c.stepper.advance(true);
  CHECK(c.stepper.state().response.fraction == 0.4);
  CHECK(c.stepper.state().response.from == NewtonProblem::rest());
  CHECK(c.problem.iterate.limited_by() == "the post");
  CHECK(c.problem.iterate.x() == NewtonProblem::rest());
  CHECK(c.loads.last == NewtonProblem::rest());

  c.move(0.02);
  c.stepper.advance(true);
  // 0.4 moved it by 0.02, so the remaining 0.6 by 0.03.
  CHECK((c.problem.iterate.x() - NewtonProblem::rest()).minCoeff() == Approx(0.05));
  CHECK((c.problem.iterate.x() - NewtonProblem::rest()).maxCoeff() == Approx(0.05));
  CHECK(c.loads.fractions == std::vector<double>{1});
  CHECK(c.loads.last == c.problem.iterate.x());
  CHECK(c.loads.complete());
  CHECK(c.stepper.state().response.fraction == 0);
  CHECK(!c.stepper.blocked());
}

TEST_CASE("A prediction that equilibrium corrects is trusted less") {
  StepperCase c;
  c.loads.allowed = 0.1;
  c.stepper.advance(true);
  LoadStepper::State state = c.stepper.state();
  // The last prediction moved the cloth by 0.02, and equilibrium by as much again.
  state.response.predicted = NewtonProblem::rest().array() + 0.02;
  c.stepper.restore(state);
  c.move(0.04);
  c.stepper.advance(true);
  // A trust of 1/4: 0.25 · 0.1 / 0.9 of the remainder, then the obstacles alone.
  REQUIRE(!c.loads.fractions.empty());
  CHECK(c.loads.fractions[0] == Approx(0.25 * 0.1 / 0.9));
  CHECK(c.stepper.state().response.fraction > c.loads.fractions[0]);
}

TEST_CASE("An increment that twenty attempts hardly advance is blocked") {
  StepperCase c;
  c.loads.allowed = 1e-4;
  for (int k = 0; k < 19; ++k) c.stepper.advance(true);
  CHECK(!c.stepper.blocked());

  StepperCase freed;
  freed.stepper.restore(c.stepper.state());
  freed.loads.allowed = 0.5;
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
