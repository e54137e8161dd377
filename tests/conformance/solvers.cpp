#include <catch2/catch.hpp>

#include "tests/support/any_threads.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

constexpr double tolerance = 1e-6;

/// A square that hangs from the corners of one side and from the middle of the opposite one, pulled together.
std::string hanging_square(const std::string& solver) {
  return R"(
name: hanging_square
cloth: {shape: square, side: 0.3, triangulation: one_way, columns: 8, rows: 8}
levels: 3
material: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e4, bending_modulus: 8e6, poisson_ratio: 0.243}
start: {scale: [0.9, 0.9, 1], perturbation: 1e-3}
pins: [{point: [0, 0, 0]}, {point: [0.3, 0, 0]}, {point: [0, 0.3, 0]}, {point: [0.3, 0.3, 0]}]
energies: [neo_hookean, hinge, gravity]
newton: {step_size: 0.1, step_growth: 2, force_tolerance: 1e-6}
methods: {)" +
         solver + ": {}}\n";
}

/// Runs the body on every solver's name.
template <class Body>
void for_each_solver(const Body& body) {
  const auto entries = test_registry().of_kind("solver");
  REQUIRE(entries.size() >= 3);
  for (const RegistryEntry* entry : entries) {
    INFO(entry->name);
    body(entry->name);
  }
}

/// Checks that a solver of these three levels has ended with the finest one, having solved coarser ones
/// before.
void require_finest_last(const std::vector<LevelResult>& levels) {
  REQUIRE(!levels.empty());
  REQUIRE(levels.back().level == 2);
  for (std::size_t k = 1; k < levels.size(); ++k) REQUIRE(levels[k - 1].level < levels[k].level);
}

}  // namespace

TEST_CASE("Every solver converges, to an equilibrium of the plain finest model, and moves no fixed vertex") {
  for_each_solver([](const std::string& name) {
    const Solved s = solve_yaml(hanging_square(name));
    require_finest_last(s.levels);
    for (const LevelResult& level : s.levels) {
      INFO("level " << level.level << ": " << level.message);
      CHECK(level.outcome == Outcome::converged);
      CHECK(level.force_residual <= tolerance);
      CHECK(level.iterations > 0);
      const auto& fixed = s.scene->models[level.level]->fixed();
      int held = 0;
      for (Eigen::Index i = 0; i < level.x.rows(); ++i) {
        if (!fixed[i]) continue;
        ++held;
        INFO("vertex " << i);
        CHECK(level.x.row(i) == s.scene->starts[level.level].row(i));
      }
      REQUIRE(held == 4);
    }
    CHECK(s.model().force_residual(s.x()) <= tolerance * (1 + 1e-9));
    REQUIRE(s.model().force_residual(s.scene->starts.back()) > 100 * tolerance);
  });
}

TEST_CASE("Solvers give the same bits from run to run, and with any number of threads") {
  for_each_solver([](const std::string& name) {
    const auto solve = [&] { return Positions(solve_yaml(hanging_square(name)).x()); };
    REQUIRE(same_with_any_threads(solve, {1, 2}).norm() > 0);
  });
}

TEST_CASE("Every solver refines early on request, on every level but the finest") {
  int refined = 0;
  struct Impatient : Observer {
    int asked = 0;
    bool refine_requested() override { return ++asked % 3 == 0; }
  };
  for_each_solver([&](const std::string& name) {
    Solved s = scene_from(hanging_square(name));
    Impatient observer;
    s.levels = s.experiment.methods[0].second->solve(*s.scene, observer);
    require_finest_last(s.levels);
    for (std::size_t l = 0; l + 1 < s.levels.size(); ++l, ++refined) {
      CHECK(s.levels[l].outcome == Outcome::refined_early_on_request);
      CHECK(s.levels[l].steps == 2);
      CHECK(s.levels[l].message.starts_with("refined on request; force residual "));
    }
    CHECK(s.levels.back().outcome == Outcome::converged);
    CHECK(observer.asked == 3 * (static_cast<int>(s.levels.size()) - 1));
  });
  REQUIRE(refined >= 2);
}
