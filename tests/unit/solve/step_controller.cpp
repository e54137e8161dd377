#include "core/numerics/step/step_controller.h"

#include <catch2/catch.hpp>

using namespace drape;

namespace {

const NewtonParameters doubling{.step_size = 1, .step_growth = 2},
    doubling_static{.form = NewtonForm::statics, .step_size = 1, .step_growth = 2};

/// A step of one iteration.
void step(StepController& c, double step_length, double force_residual = 1) {
  c.begin_step();
  c.end_iteration(step_length);
  c.end_step(force_residual);
}

}  // namespace

TEST_CASE("The step size grows after full steps up to its limit, and shrinks after short ones") {
  const NewtonParameters p{.step_size = 250, .step_growth = 2};
  StepController c(p);
  step(c, 1);
  CHECK(c.step_size() == 500);
  CHECK(c.inverse_h2() == 1 / 250e3);
  step(c, 1);
  step(c, 1);
  CHECK(c.step_size() == 1000);
  step(c, 0.5);
  CHECK(c.step_size() == 1000);
  step(c, 0.2);
  CHECK(c.step_size() == 500);
}

TEST_CASE("The static form keeps the step size, which scales its decrement") {
  StepController c(doubling_static);
  step(c, 1);
  step(c, 0.1);
  CHECK(c.step_size() == 1);
}

TEST_CASE("The shortest of a step's iterations adapts the step size") {
  StepController c(doubling);
  c.begin_step();
  c.end_iteration(0.2);
  c.end_iteration(1);
  c.end_step(1);
  CHECK(c.step_size() == 0.5);
}

TEST_CASE("Short steps reduce the step size to 1e-8 s and no further") {
  const NewtonParameters p{.step_size = 1e-7, .step_growth = 1000};
  StepController c(p);
  step(c, 0.1);
  step(c, 0.1);
  CHECK(c.step_size() == StepController::min_step_size);
}

TEST_CASE("Without descent the step size is quartered down to 1e-8 s; an abandoned step resets it") {
  StepController c(doubling);
  c.begin_step();
  CHECK(c.damp());
  CHECK(c.step_size() == 0.25);
  int quartered = 1;
  while (c.damp()) REQUIRE(++quartered < 20);
  CHECK(quartered == 13);  // 4^-13 is the last above 1e-8
  c.abandon_step();
  CHECK(c.step_size() == 1);
}

TEST_CASE("The static form adds ten times more mass each time, until an iteration succeeds") {
  StepController c(doubling_static);
  CHECK(c.is_static());
  CHECK(c.mass_shift() == 0);
  c.begin_step();
  CHECK(c.damp());
  CHECK(c.mass_shift() == Approx(1e-3));
  CHECK(c.damp());
  CHECK(c.mass_shift() == Approx(1e-2));
  c.end_iteration(1);
  CHECK(c.mass_shift() == 0);
  int times = 0;
  while (c.damp()) REQUIRE(++times < 30);
  CHECK(times >= 18);  // 1e-3 … 1e15
  CHECK(c.inverse_h2() == 0);
  c.abandon_step();
  CHECK(c.mass_shift() == 0);
}

TEST_CASE(
    "After twenty stalled steps the step size is divided by 16 and does not grow until forces recover") {
  StepController c(doubling);
  for (int k = 0; k < 19; ++k) step(c, 0.5, 2e3);
  CHECK(c.step_size() == 1);
  step(c, 0.5, 2e3);
  CHECK(c.step_size() == 1.0 / 16);
  step(c, 1, 100);
  CHECK(c.step_size() == 1.0 / 16);
  CHECK(c.state().backed_off);

  StepController recovers = c;
  step(recovers, 1, 5);
  CHECK(recovers.step_size() == 1.0 / 8);

  // One step without a stall is behind; after twenty the step size grows again.
  for (int k = 0; k < 18; ++k) step(c, 1, 100);
  CHECK(c.step_size() == 1.0 / 16);
  step(c, 1, 100);
  CHECK(c.step_size() == 1.0 / 8);
}

TEST_CASE("Where even the smallest step size has not ended a stall, steps begin with the first one again") {
  StepController c(doubling);
  for (int k = 0; k < 20 * 7; ++k) step(c, 0.5, 2e3);  // 16⁻⁷ < 1e-8
  CHECK(c.step_size() == StepController::min_step_size);
  CHECK(c.state().backed_off);
  for (int k = 0; k < 20; ++k) step(c, 0.5, 2e3);
  CHECK(c.step_size() == doubling.step_size);
  CHECK_FALSE(c.state().backed_off);
}

TEST_CASE("Where steps repeat each other h is limited to a quarter, again and again, until the limit ends") {
  StepController c(doubling);
  step(c, 1);
  step(c, 1);
  CHECK(c.step_size() == 4);
  c.limit_step_size();
  CHECK(c.step_size() == 1);
  step(c, 1);
  CHECK(c.step_size() == 1);
  c.limit_step_size();
  CHECK(c.step_size() == 0.25);
  StepController other(doubling);
  other.restore(c.state());
  step(other, 1);
  CHECK(other.step_size() == 0.25);
  c.end_limit();
  step(c, 1);
  CHECK(c.step_size() == 0.5);

  StepController inertia(doubling_static);
  CHECK(inertia.inverse_h2() == 0);
  inertia.limit_step_size();
  CHECK(inertia.inverse_h2() == 1 / 62500.0);  // 1000 s by four
  inertia.limit_step_size();
  CHECK(inertia.inverse_h2() == 16 / 62500.0);
  inertia.end_limit();
  CHECK(inertia.inverse_h2() == 0);
}

TEST_CASE("Steps that begin with the first h again keep to the limit of a cycle") {
  StepController c(doubling);
  StepController::State state = c.state();
  state.step_size = StepController::min_step_size;
  state.cycle_limit = 0.25;
  c.restore(state);
  for (int k = 0; k < 20; ++k) step(c, 0.5, 2e3);
  CHECK(c.step_size() == 0.25);
}
