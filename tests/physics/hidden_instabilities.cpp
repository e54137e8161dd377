// Twelve exactly symmetric starts that hide an instability: every end is a minimum.

#include <catch2/catch.hpp>

#include "tests/support/symmetric_scenes.h"

using namespace drape;

TEST_CASE("Symmetric starts hide no instability: every end is a minimum of lower energy") {
  table("Energy [J] of ends that a symmetric start leads to, and of the minima that exits find", "scene",
        "method", "symmetric", "minimum", "exits", "1/s²");
  for (const Symmetric& scene : symmetric_scenes())
    for (const char* method : {"pcs", "newton"}) {
      INFO(scene.name << ", " << method);
      const Solved symmetric = scene.solved(method, false), end = scene.solved(method, true);
      const auto energy = [](const Solved& s) { return s.model().energy(s.x()); };
      int exits = 0;
      for (const LevelResult& level : end.levels) {
        CHECK(level.outcome == Outcome::converged);
        exits += level.saddles_left;
      }
      row(scene.name, method, energy(symmetric), energy(end), exits, stability_of(end).lowest_eigenvalue);
      CHECK(symmetric.levels.back().outcome == Outcome::converged);
      CHECK_FALSE(symmetric.levels.back().stability);
      CHECK(exits > 0);
      CHECK(stability_of(end).verdict == Stability::stable);
      CHECK(energy(end) < energy(symmetric) - 1e-7 * std::abs(energy(symmetric)));
    }
}

TEST_CASE(
    "A level that ends at no equilibrium has no stability, and the level's own tolerance decides at its last "
    "step") {
  const std::string sheet = replaced(symmetric_scenes()[5].keys, "pins:", "newton: {max_steps: 3}\npins:");
  Solved s = scene_from(two_levels + sheet);
  run_method(s, "newton");
  for (const LevelResult& level : s.levels) {
    CAPTURE(level.message, level.force_residual);
    CHECK((level.outcome == Outcome::max_steps_reached) == (level.force_residual > 1e-3));
    CHECK(level.stability.has_value() == has_converged(level.outcome));
  }
}
