#include "core/numerics/step/step_controller.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "core/numerics/step/cycle_detector.h"

using namespace drape;

namespace {

const NewtonParameters doubling{.step_size = 1, .step_growth = 2},
    doubling_static{.form = NewtonForm::statics, .step_size = 1, .step_growth = 2};
constexpr double stalled = 2e3;  // a force residual

/// Steps of one iteration each; returns the step size after them.
double after_steps(StepController& c, int count, double step_length, double force_residual = 1) {
  for (int k = 0; k < count; ++k) {
    c.begin_step();
    c.end_iteration(step_length);
    c.end_step(force_residual);
  }
  return c.step_size();
}

/// How often the step can be damped.
int damped(StepController& c) {
  int times = 0;
  while (c.damp()) REQUIRE(++times < 30);
  return times;
}

/// The first step after which the detector reports a cycle, -1 for none in 200.
int detected(const std::function<double(int)>& energy, const std::function<double(int)>& residual) {
  CycleDetector detector;
  for (int k = 0; k < 200; ++k) {
    detector.note(energy(k), residual(k));
    if (detector.cycling()) return k;
  }
  return -1;
}

int detected(const std::function<double(int)>& both) { return detected(both, both); }

}  // namespace

TEST_CASE("The step size grows after full steps up to its limit, and shrinks after short ones") {
  const NewtonParameters p{.step_size = 250, .step_growth = 2};
  StepController c(p);
  CHECK(c.inverse_h2() == 1 / 62500.0);
  CHECK(after_steps(c, 1, 1) == 500);
  CHECK(after_steps(c, 2, 1) == 1000);
  CHECK(after_steps(c, 1, 0.5) == 1000);
  CHECK(after_steps(c, 1, 0.2) == 500);
  c.begin_step();  // of several iterations the shortest counts
  c.end_iteration(0.2);
  c.end_iteration(1);
  c.end_step(1);
  CHECK(c.step_size() == 250);

  const NewtonParameters tiny{.step_size = 1e-7, .step_growth = 1000};
  StepController least(tiny);
  CHECK(after_steps(least, 2, 0.1) == StepController::min_step_size);

  StepController kept(doubling_static);  // it scales the static form's decrement
  CHECK(after_steps(kept, 1, 1) == 1);
  CHECK(after_steps(kept, 1, 0.1) == 1);
}

TEST_CASE("Without descent the step size is quartered down to 1e-8 s; an abandoned step resets it") {
  StepController c(doubling);
  c.begin_step();
  CHECK(c.damp());
  CHECK(c.step_size() == 0.25);
  CHECK(damped(c) == 12);  // 4^-13 is the last above 1e-8
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
  CHECK(damped(c) >= 18);  // 1e-3 … 1e15
  CHECK(c.inverse_h2() == 0);
  c.abandon_step();
  CHECK(c.mass_shift() == 0);
}

TEST_CASE("After twenty stalled steps h is divided by 16 and does not grow until forces recover") {
  StepController c(doubling);
  CHECK(after_steps(c, 19, 0.5, stalled) == 1);
  CHECK(after_steps(c, 1, 0.5, stalled) == 1.0 / 16);
  CHECK(after_steps(c, 1, 1, 100) == 1.0 / 16);
  CHECK(c.state().backed_off);
  StepController recovers = c;
  CHECK(after_steps(recovers, 1, 1, 5) == 1.0 / 8);
  // One step without a stall is behind; after twenty the step size grows again.
  CHECK(after_steps(c, 18, 1, 100) == 1.0 / 16);
  CHECK(after_steps(c, 1, 1, 100) == 1.0 / 8);
}

TEST_CASE("Where even the smallest step size has not ended a stall, steps begin with the first one again") {
  StepController c(doubling);
  CHECK(after_steps(c, 20 * 7, 0.5, stalled) == StepController::min_step_size);  // 16⁻⁷ < 1e-8
  CHECK(c.state().backed_off);
  StepController limited = c;  // by a cycle before
  StepController::State state = c.state();
  state.cycle_limit = 0.25;
  limited.restore(state);
  CHECK(after_steps(limited, 20, 0.5, stalled) == 0.25);
  CHECK(after_steps(c, 20, 0.5, stalled) == 1);
  CHECK_FALSE(c.state().backed_off);
}

TEST_CASE("Where steps repeat each other h is limited to a quarter, again and again, until the limit ends") {
  StepController c(doubling);
  CHECK(after_steps(c, 2, 1) == 4);
  c.limit_step_size();
  CHECK(c.step_size() == 1);
  CHECK(after_steps(c, 1, 1) == 1);
  c.limit_step_size();
  CHECK(c.step_size() == 0.25);
  StepController other(doubling);
  other.restore(c.state());
  CHECK(after_steps(other, 1, 1) == 0.25);
  c.end_limit();
  CHECK(after_steps(c, 1, 1) == 0.5);

  StepController inertia(doubling_static);
  CHECK(inertia.inverse_h2() == 0);
  for (const double inverse_h2 : {1 / 62500.0, 16 / 62500.0}) {  // 1000 s by four, and again
    inertia.limit_step_size();
    CHECK(inertia.inverse_h2() == inverse_h2);
  }
  inertia.end_limit();
  CHECK(inertia.inverse_h2() == 0);
}

TEST_CASE("States that repeat every two to eight steps are a cycle after twelve returns") {
  for (int period = 2; period <= 8; ++period)
    CHECK(detected([&](int k) { return 1 + 1e-6 * (k % period); }) == period + 11);
  CHECK(detected([](int k) { return 1 + 1e-6 * (k % 9); }) == -1);
  // The first steps differ; so does the limit cycle, until it is nearly reached.
  CHECK(detected([](int k) { return std::exp(-0.5 * k) + (k % 2 ? 1 : -1); }) > 13);
}

TEST_CASE("What converges, however slowly, or stands still is no cycle") {
  CHECK(detected([](int k) { return std::exp(-1e-4 * k); }) == -1);
  CHECK(detected([](int k) { return 1 + std::pow(-0.95, k); }) == -1);
  CHECK(detected([](int k) { return 1 + std::pow(0.99, k) * std::cos(2 * M_PI * k / 5); }) == -1);
  CHECK(detected([](int) { return 1.0; }) == -1);
  CHECK(detected([](int k) { return -1e-9 * k; }, [](int k) { return 1.0 + k % 2; }) == -1);  // descends
  CHECK(detected([](int) { return std::nan(""); }) == -1);
}
