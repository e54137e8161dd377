#include <catch2/catch.hpp>
#include <string>

#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

/// A strip of 1 m by 5 mm that hangs from its end like a fishing rod.
std::string strip(const std::string& bending_modulus, const std::string& force_tolerance,
                  const std::string& more = "") {
  return "name: strip\ncloth: {shape: rectangle, size: [1, 0.005], columns: 201, rows: 3}\nlevels: 1\n"
         "material: {density: 1000, thickness: 0.001, poisson_ratio: 0.3, membrane_modulus: 1e9, "
         "bending_modulus: " +
         bending_modulus +
         "}\npins: [{region: box, lower: [-1, -1, -1], upper: [0.006, 1, 1]}]\n"
         "energies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n"
         "newton: {max_steps: 700, force_tolerance: " +
         force_tolerance + "}\n" + more;
}

/// Far below rounding.
const std::string too_tight = "1e-10";

}  // namespace

TEST_CASE("Stiff narrow strips end at the rounding floor, along either path", "[physics]") {
  // Once without any descent, once with idle steps until max_steps.
  for (const char* bending : {"1e7", "1e9"}) {
    const Solved s = solve_yaml(strip(bending, too_tight));
    const LevelResult& r = s.levels.back();
    CAPTURE(bending, r.steps, r.message);
    CHECK(r.outcome == Outcome::converged_to_rounding);
    CHECK_THAT(r.message, Contains("the force residual is ") && Contains("above force_tolerance = 1e-10"));
    CHECK(r.force_residual < 2e-6);
    // It hangs where it does under a tolerance that can be met.
    const Solved loose = converged(solve_yaml(strip(bending, "1e-5")));
    CHECK((r.x - loose.x()).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("Under a schedule the rounding floor counts as equilibrium", "[physics]") {
  const Solved s = solve_yaml(strip("1e9", too_tight,
                                    "schedule: {steps: 3, equilibrate: true, keys: [{parameter: "
                                    "energies.gravity.acceleration, times: [0, 1], "
                                    "values: [[0, 0, -9.81], [0, 0, -12]]}]}\n"));
  const LevelResult& r = s.levels.back();
  CAPTURE(r.steps, r.message);
  CHECK(r.outcome == Outcome::converged_to_rounding);
  CHECK(r.load_stepping.increment == 3);
}
