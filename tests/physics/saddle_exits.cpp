// Exits from saddles: their bits, with contact, friction and other factorisations; and what a walk leaves
// behind.

#include <catch2/catch.hpp>

#include "tests/support/symmetric_scenes.h"

using namespace drape;

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
