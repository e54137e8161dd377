// Levels that end at the rounding floor, and with a barrier that is too weak.

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/solve/newton_report.h"
#include "tests/support/known_answers.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

/// A square of cloth, whose weight is 1.47 Pa, over a ball; `model` is the contact model.
std::string over_a_ball(const std::string& model, const std::string& stiffness, int steps) {
  return experiment(R"(cloth: {shape: square, side: 0.5, columns: 12, rows: 12}
material: {bending_modulus: 8e5}
start: {translate: [-0.25, -0.25, 0.11]}
energies: [neo_hookean, hinge, gravity]
contact: {type: $, stiffness: $}
friction: 0.4
obstacles: [{name: ball, $: sphere, radius: 0.1}]
newton: {max_steps: $}
)",
                    model, stiffness, model == "ipc" ? "meshed_shape" : "shape", steps);
}

/// A strip of 1 m by 5 mm that hangs from its end like a fishing rod.
LevelResult rod(const std::string& bending_modulus, const std::string& force_tolerance,
                const std::string& more = "") {
  return solve_yaml(experiment(R"(cloth: {shape: rectangle, size: [1, 0.005], columns: 201, rows: 3}
material: {density: 1000, thickness: 0.001, poisson_ratio: 0.3, membrane_modulus: 1e9, bending_modulus: $}
pins: [{region: box, lower: [-1, -1, -1], upper: [0.006, 1, 1]}]
energies: [neo_hookean, hinge, gravity]
newton: {max_steps: 700, force_tolerance: $}
$)",
                               bending_modulus, force_tolerance, more))
      .levels.back();
}

const std::string far_below_rounding = "1e-10";

}  // namespace

TEST_CASE("A failed run names a barrier that is too weak for the load, and a suitable stiffness") {
  for (const char* model : {"ipc", "shapes"}) {
    const Solved s = solve_yaml(over_a_ball(model, "1.47e-4", 60));
    const LevelResult& r = s.levels.back();
    CAPTURE(r.message);
    REQUIRE(r.outcome == Outcome::max_steps_reached);
    CHECK(*r.smallest_gap < 1e-6);
    CHECK_THAT(r.message,
               Contains("; the barrier is too weak for the load: its stiffness is 0.000147 Pa but the "
                        "load's pressure is 1.47 Pa, and the gap between ") &&
                   Contains("cloth triangle ") && Contains("ball") && Contains("stiffness to about 14.7 "));
    // Without contacts no barrier is named.
    CHECK(weak_barrier(s.model(), s.scene->starts.back()).empty());
  }
}

TEST_CASE("A suitable barrier is not named, however small a gap is") {
  for (const char* model : {"ipc", "shapes"})
    for (const char* stiffness : {"null", "1.5"}) {
      CAPTURE(model, stiffness);
      const Solved s = converged(solve_yaml(over_a_ball(model, stiffness, 1000)));
      const BoundContact& bound = *s.model().contacts()[0];
      CHECK(bound.smallest_gap(s.x()).gap == Approx(*s.levels.back().smallest_gap));
      CHECK(weak_barrier(s.model(), s.x()).empty());
      // Something other than the load presses the cloth onto the ball.
      Positions x = s.x();
      for (double step = 1e-4; bound.smallest_gap(x).gap > 1e-7;) {
        Positions lower = x;
        lower.col(2).array() -= step;
        if (bound.smallest_gap(lower).gap > 0 && bound.intersections(lower).empty())
          x = lower;
        else
          step /= 2;
      }
      CHECK(weak_barrier(s.model(), x).empty());
    }
}

TEST_CASE("Stiff narrow strips end at the rounding floor, along either path") {
  // Once without any descent, once with idle steps until max_steps.
  for (const char* bending : {"1e7", "1e9"}) {
    const LevelResult r = rod(bending, far_below_rounding);
    CAPTURE(bending, r.steps, r.message);
    CHECK(r.outcome == Outcome::converged_to_rounding);
    CHECK_THAT(r.message, Contains("the force residual is ") && Contains("above force_tolerance = 1e-10"));
    CHECK(r.force_residual < 2e-6);
    // It hangs where it does under a tolerance that can be met.
    const LevelResult loose = rod(bending, "1e-5");
    REQUIRE(loose.outcome == Outcome::converged);
    CHECK((r.x - loose.x).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("Under a schedule the rounding floor counts as equilibrium") {
  const LevelResult r = rod("1e9", far_below_rounding, R"(schedule:
  steps: 3
  equilibrate: true
  keys: [{parameter: energies.gravity.acceleration, times: [0, 1], values: [[0, 0, -9.81], [0, 0, -12]]}]
)");
  CAPTURE(r.steps, r.message);
  CHECK(r.outcome == Outcome::converged_to_rounding);
  CHECK(r.load_stepping.increment == 3);
}
