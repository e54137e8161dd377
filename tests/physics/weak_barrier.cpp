#include <catch2/catch.hpp>
#include <string>
#include <utility>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/solve/newton_report.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

/// A contact model, and the key that its obstacles have.
const std::pair<std::string, std::string> ball_models[] = {{"ipc", "meshed_shape"}, {"shapes", "shape"}};

/// A square of cloth, whose weight is 1.47 Pa, over a ball.
std::string over_a_ball(const std::pair<std::string, std::string>& model, const std::string& stiffness,
                        int steps) {
  return "name: ball\ncloth: {shape: square, side: 0.5, columns: 12, rows: 12}\nlevels: 1\n"
         "material: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e4, bending_modulus: 8e5}\n"
         "start: {translate: [-0.25, -0.25, 0.11]}\nenergies: [neo_hookean, hinge, gravity]\n"
         "newton: {max_steps: " +
         std::to_string(steps) + "}\nmethods: {newton: {}}\ncontact: {type: " + model.first +
         ", stiffness: " + stiffness + "}\nfriction: 0.4\nobstacles: [{name: ball, " + model.second +
         ": sphere, radius: 0.1}]\n";
}

}  // namespace

TEST_CASE("A failed run names a barrier that is too weak for the load, and a suitable stiffness") {
  for (const auto& model : ball_models) {
    const Solved s = solve_yaml(over_a_ball(model, "1.47e-4", 60));
    const LevelResult& r = s.levels.back();
    CAPTURE(r.message);
    REQUIRE(r.outcome == Outcome::max_steps_reached);
    CHECK(*r.smallest_gap < 1e-6);
    CHECK_THAT(r.message,
               Contains("; the barrier is too weak for the load: its stiffness is 0.000147 Pa but the "
                        "load's pressure is 1.47 Pa, and the gap between ") &&
                   Contains("cloth triangle ") && Contains("ball") &&
                   Contains(" of the contact's dhat; set its stiffness to about 14.7 (null chooses it "
                            "from the cloth's weight)"));
    // Without contacts no barrier is named.
    CHECK(weak_barrier(s.model(), s.scene->starts.back()).empty());
  }
}

TEST_CASE("A suitable barrier is not named, however small a gap is") {
  for (const auto& model : ball_models)
    for (const char* stiffness : {"null", "1.5"}) {
      CAPTURE(model.first, stiffness);
      const Solved s = converged(solve_yaml(over_a_ball(model, stiffness, 1000)));
      const BoundContact& bound = *s.model().contacts()[0];
      CHECK(bound.smallest_gap(s.x()).gap == Approx(*s.levels.back().smallest_gap));
      CHECK(weak_barrier(s.model(), s.x()).empty());
      // Something other than the load presses the cloth onto the ball.
      Positions x = s.x();
      double step = 1e-4;
      while (bound.smallest_gap(x).gap > 1e-7) {
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
