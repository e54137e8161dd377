#include <catch2/catch.hpp>

#include "core/kernel/interfaces/refiner.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "tests/conformance/energy_states.h"
#include "tests/conformance/meshes.h"
#include "tests/support/any_threads.h"
#include "tests/support/decompositions.h"
#include "tests/support/meshes.h"

using namespace drape;
using namespace energy_states;

TEST_CASE("An energy has the derivatives of its value, and semidefinite projected Hessians") {
  int indefinite = 0;
  for_each_binding([&](const Candidate& candidate, const Level& level, const BoundEnergy& energy) {
    for (const State& s : states(candidate, level)) {
      INFO(s.name);
      const Positions g = gradient_of(energy, s.x), before = noise(s.x.rows(), 1, 6);
      check_derivatives(energy, s.x, s.step);
      Positions sum = before;
      CHECK(energy.add_gradient(s.x, sum) == Approx(energy.value(s.x)).epsilon(1e-13));
      CHECK((sum - before - g).norm() <= 1e-13 * (g.norm() + before.norm()));
      const BlockMatrix h = hessian_of(energy, s.x, Projection::none);
      for (int i = 0; i < h.pattern->rows(); ++i) {
        const Eigen::Map<const Eigen::Matrix3d> diagonal(h.block(h.pattern->find(i, i)));
        REQUIRE((diagonal - diagonal.transpose()).norm() <= 1e-13 * diagonal.norm());
      }
      if (energy.stencils().rows() == 0) continue;
      REQUIRE(dense(h).norm() > 0);
      indefinite += check_projections(energy, s.x);
    }
  });
  REQUIRE(indefinite > 0);  // else nothing was projected
}

TEST_CASE("Internal energies are invariant under rigid motions") {
  for_each_binding([](const Candidate& candidate, const Level& level, const BoundEnergy& energy) {
    if (!candidate.internal()) return;
    for (const State& s : states(candidate, level)) {
      INFO(s.name);
      const Positions moved = (s.x * some_turn.transpose()).rowwise() + Eigen::RowVector3d(0.3, -0.2, 0.7);
      REQUIRE(energy.value(s.x) > 0);
      CHECK(energy.value(moved) == Approx(energy.value(s.x)).epsilon(1e-9));
      const Positions g = gradient_of(energy, s.x) * some_turn.transpose();
      CHECK((gradient_of(energy, moved) - g).norm() <= 1e-9 * g.norm());
    }
  });
}

TEST_CASE("Energies give the same bits with any number of threads") {
  const Level level = Level::of(0, random_triangulation({0.6, 0.5}, 3000, 9));
  const Positions x = level.rest.vertices + noise(level.vertex_count(), 0.002, 10);
  for (const Candidate& candidate : all_energies()) {
    INFO(candidate.name);
    const auto energy = candidate.energy->bind(level, material);
    same_with_any_threads([&] {
      return std::tuple(energy->value(x), gradient_of(*energy, x),
                        hessian_of(*energy, x, Projection::clamp).values);
    });
  }
}

TEST_CASE("The rest shape of every level of every hierarchy is stress-free") {
  int checked = 0;
  for (const RegistryEntry* entry : test_registry().of_kind("refiner"))
    for (const NamedMesh& m : meshes_to_refine()) {
      const Hierarchy hierarchy = Hierarchy::of(m.mesh, *make_plugin_from<Refiner>(entry->name), 3);
      for (const Candidate& candidate : all_energies()) {
        if (!candidate.internal() || candidate.prestressed) continue;
        for (const Level& level : hierarchy.levels) {
          INFO(candidate.name << ", " << m.name << " refined by " << entry->name << ", level "
                              << level.index);
          const auto energy = bind(candidate, level);
          if (!energy) continue;
          const Positions& rest = level.rest.vertices;
          const BlockMatrix h = hessian_of(*energy, candidate.enlarged() * rest, Projection::none);
          const double stiffness =
              Eigen::Map<const Eigen::VectorXd>(h.values.data(), static_cast<Eigen::Index>(h.values.size()))
                  .lpNorm<Eigen::Infinity>();
          REQUIRE(stiffness > 0);
          CHECK(gradient_of(*energy, rest).cwiseAbs().maxCoeff() <= 1e-14 * stiffness);
          // Squares of strains vanish to the square of round-off [m² a triangle]; Ogden's terms, which
          // cancel, to round-off.
          const double rounding = candidate.name.ends_with("ogden")
                                      ? std::numeric_limits<double>::epsilon() * level.vertex_area.sum()
                                      : 1e-26 * level.triangle_count();
          CHECK(std::abs(energy->value(rest)) <= rounding * stiffness);
          ++checked;
        }
      }
    }
  REQUIRE(checked >= 2 * 6 * 3 * 3);
}

TEST_CASE("A collapsed triangle has an energy that is a number or +infinity") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Level level = flat_level();
  const auto v = level.rest.triangles.row(11);
  int infinite = 0;
  for (const Candidate& candidate : all_energies()) {
    if (!candidate.internal()) continue;
    INFO(candidate.name);
    const auto energy = candidate.energy->bind(level, material);
    const auto flat_to = [&](double part) {
      return energy->value(flattened(level, level.rest.vertices, 11, part));
    };
    const bool unbounded = flat_to(1e-12) - flat_to(1e-6) > 0.1 * (flat_to(1e-6) - flat_to(1));

    std::vector<Positions> collapsed(3, level.rest.vertices);
    collapsed[0].row(v[1]) = collapsed[0].row(v[0]);
    collapsed[1].row(v[1]) = collapsed[1].row(v[2]) = collapsed[1].row(v[0]);
    for (const int k : {0, 1, 2})  // on a line, with coordinates that round to nothing
      collapsed[2].row(v[k]) << 0.25 * k, 0, 0;
    for (const Positions& x : collapsed) {
      Positions g = Positions::Zero(x.rows(), 3);
      const double value = energy->value(x), returned = energy->add_gradient(x, g);
      CHECK_FALSE(std::isnan(value));
      CHECK(value >= 0);
      CHECK((value == returned || returned == Approx(value).epsilon(1e-13)));
      if (unbounded) CHECK(value == infinity);
    }
    infinite += unbounded;
  }
  REQUIRE(infinite >= 1);
}

TEST_CASE("A rest shape with a triangle without area is refused, and a single triangle does not bend") {
  Level level = Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way));
  level.rest.vertices.row(4) = level.rest.vertices.row(0);
  const Level single = Level::of(0, mesh_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}));
  const Positions x = single.rest.vertices + noise(3, 0.1, 12);
  for (const Candidate& candidate : all_energies()) {
    INFO(candidate.name);
    if (candidate.internal() && !candidate.name.starts_with("springs"))  // a spring needs its edge alone
      CHECK_THROWS_WITH(candidate.energy->bind(level, material),
                        Catch::Contains(" of level 0 has no area at rest") ||
                            Catch::Contains("the rest shape of level 0 is not flat"));
    if (candidate.energy->role() != EnergyRole::bending) continue;
    const auto energy = candidate.energy->bind(single, material);
    CHECK(energy->value(x) == 0);
    CHECK(gradient_of(*energy, x).isZero(0));
    CHECK(dense(hessian_of(*energy, x, Projection::clamp)).isZero(0));
  }
}

TEST_CASE("Energies: midpoint_factor holds on the surface split at midpoints") {
  int factors = 0;
  for_each_binding([&](const Candidate& candidate, const Level& level, const BoundEnergy& bound) {
    const std::optional<double> factor = candidate.energy->midpoint_factor();
    if (!factor) return;
    ++factors;
    const ProlongationMatrix midpoints = midpoint_weights(level);
    const Level fine = Level::of(1, refined_rest(level, midpoints));
    const auto finer = candidate.energy->bind(fine, material);
    for (const State& state : states(candidate, level)) {
      INFO(state.name);
      const double expected = *factor * bound.value(state.x);
      REQUIRE(expected != 0);
      CHECK(finer->value(midpoints * state.x) == Approx(expected).epsilon(1e-9));
    }
  });
  CHECK(factors >= 10);
}

TEST_CASE("Membranes of coarse levels have consistent derivatives, resist less and soften") {
  const Level level = Level::of(0, grid({0.1, 0.1}, 2, 2, Diagonals::one_way));
  int membranes = 0, relaxed = 0;
  for (const Candidate& candidate : all_energies()) {
    if (candidate.energy->role() != EnergyRole::membrane) continue;
    ++membranes;
    INFO(candidate.name);
    const auto plain = candidate.energy->bind(level, material);
    if (!candidate.energy->bind_buckling(level, material, 0)) continue;
    for (const double bound : {0.0, 1e-5, 1e-3}) {
      const auto buckling = candidate.energy->bind_buckling(level, material, bound);
      CHECK(buckling->stencils() == plain->stencils());
      for (const Eigen::Vector3d& stretch :
           {Eigen::Vector3d(1.05, 1.02, 1), Eigen::Vector3d(1.05, 0.8, 1), Eigen::Vector3d(0.9, 0.8, 1),
            Eigen::Vector3d(1.2, 0.3, 1), Eigen::Vector3d(0.4, 0.3, 1)}) {
        INFO("bound " << bound << ", stretches " << stretch.transpose());
        const Positions x = level.rest.vertices * stretch.asDiagonal() * some_turn.transpose();
        check_derivatives(*buckling, x, 1e-6, 1e-7, 1e-6);
        const Eigen::MatrixXd clamped = dense(hessian_of(*buckling, x, Projection::clamp));
        CHECK(eigenvalues_of(clamped).minCoeff() >= -1e-12 * clamped.norm());
        CHECK(buckling->value(x) <= plain->value(x) * (1 + 1e-12));
      }
    }
    const Positions narrow = level.rest.vertices * Eigen::Vector3d(1.05, 0.8, 1).asDiagonal();
    const double own = plain->value(narrow),
                 slack = candidate.energy->bind_buckling(level, material, 0)->value(narrow);
    CHECK(slack < 0.5 * own);
    ++relaxed;
    if (!candidate.energy->midpoint_factor()) continue;  // its law depends on sizes
    Level soft = level;
    soft.softening = Eigen::Vector2d(0.25, 0.25);
    CHECK(candidate.energy->bind_buckling(soft, material, 0.25e-3)->value(narrow) ==
          Approx(0.25 * candidate.energy->bind_buckling(level, material, 1e-3)->value(narrow)).epsilon(1e-9));
  }
  CHECK(membranes >= 2);
  CHECK(relaxed >= 4);
}

TEST_CASE("plate_stiffness is that of a sheet rolled along its grid") {
  constexpr double radius = 10, cell = 0.1;
  int stiff = 0;
  for (const Candidate& candidate : all_energies()) {
    const double stiffness = candidate.energy->plate_stiffness(material);
    INFO(candidate.name);
    CHECK((stiffness > 0) == (candidate.energy->role() == EnergyRole::bending));
    if (stiffness == 0 || candidate.prestressed) continue;
    ++stiff;
    const auto energy = [&](int columns, int rows) {
      const Level level =
          Level::of(0, grid({columns * cell, rows * cell}, columns + 1, rows + 1, Diagonals::one_way));
      return candidate.energy->bind(level, material)->value(rolled(level.rest.vertices, radius));
    };
    const int n = 5;  // n × n cells far from the border: what borders have cancels
    const double inner = energy(2 * n, 2 * n) - energy(n, 2 * n) - energy(2 * n, n) + energy(n, n);
    CHECK(inner / std::pow(n * cell, 2) == Approx(stiffness / (2 * radius * radius)).epsilon(1e-3));
  }
  CHECK(stiff >= 3);
}
