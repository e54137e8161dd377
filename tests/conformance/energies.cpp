#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/any_threads.h"
#include "tests/support/conformance.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"

using namespace drape;

namespace {

struct Candidate {
  std::string name;
  std::shared_ptr<Energy> energy;
  /// Whether the rest shape is not one of equilibrium, as its conformance_prestressed….yaml says.
  bool prestressed = false;
  /// Whether it depends on the cloth's shape alone, not on where the cloth is.
  bool internal() const {
    return energy->role() != EnergyRole::external && energy->role() != EnergyRole::position;
  }
  /// Scale on the rest shape for a state with stiffness: strain limits have none at rest.
  double enlarged() const { return energy->role() == EnergyRole::limit ? 1.2 : 1; }
};

/// Every registered energy, with each of the settings that it asks to be tested with.
std::vector<Candidate> all_energies() {
  std::vector<Candidate> all;
  for (const RegistryEntry* entry : test_registry().of_kind("energy")) {
    for (const auto& [name, parameters] : conformance_parameters(*entry))
      all.push_back({entry->name + " with " + name,
                     make_plugin_from<Energy>(conformance_config(*entry, parameters)),
                     name.find("prestressed") != std::string::npos});
  }
  REQUIRE(all.size() >= 3);
  return all;
}

/// Equally stiff in bending and stretching on meshes with edges of about 0.1 m: tests see both.
const Material material = [] {
  Material m;
  m.thickness = 0.01;
  m.membrane_modulus = 1e4;
  m.bending_modulus = 1e7;
  m.poisson_ratio = 0.3;
  return m;
}();

Level flat_level() { return Level::of(0, random_triangulation({0.6, 0.5}, 40, 7)); }

TriangleMesh curved_mesh() {
  TriangleMesh mesh = random_triangulation({0.6, 0.5}, 40, 8);
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i)
    mesh.vertices(i, 2) = 0.2 * std::sin(5 * mesh.vertices(i, 0)) * std::cos(4 * mesh.vertices(i, 1));
  return mesh;
}

/// Null if the energy refuses the level because it is not flat.
std::unique_ptr<BoundEnergy> bind(const Candidate& candidate, const Level& level) {
  try {
    return candidate.energy->bind(level, material);
  } catch (const std::runtime_error& error) {
    INFO(candidate.name);
    REQUIRE_FALSE(level.rest.vertices.col(2).isZero(0));
    REQUIRE_THAT(error.what(),
                 Catch::Contains("the rest shape of level " + std::to_string(level.index) + " is not flat"));
    return nullptr;
  }
}

struct State {
  std::string name;
  Positions x;
  double step;  // of finite differences [m], far below the state's smallest length
};

/// Moves the first vertex of the triangle towards the opposite edge's midpoint until `fraction` of the height
/// is left.
Positions flattened(const Level& level, Positions x, int triangle, double fraction) {
  const auto v = level.rest.triangles.row(triangle);
  const Eigen::RowVector3d middle = (x.row(v[1]) + x.row(v[2])) / 2;
  x.row(v[0]) = middle + fraction * (x.row(v[0]) - middle);
  return x;
}

std::vector<State> states(const Candidate& candidate, const Level& level) {
  const Positions& rest = level.rest.vertices;
  const int n = level.vertex_count();
  std::vector<State> all;
  all.push_back({"near rest", candidate.enlarged() * rest + noise(n, 0.002, 1), 1e-5});
  all.push_back({"random", rest + noise(n, 0.02, 2), 1e-5});

  Eigen::Matrix3d deform;
  deform << 1.7, 0.4, 0, -0.3, 0.6, 0, 0.2, 0.5, 1;
  Positions strong = rest * deform.transpose() + noise(n, 0.05, 3);
  for (int i = 0; i < n; ++i) strong(i, 2) += 0.15 * std::sin(12 * rest(i, 0));
  all.push_back({"strongly deformed", strong, 1e-5});

  Positions folded = rest + noise(n, 0.01, 4);  // about a crease across the middle, nearly shut
  for (int i = 0; i < n; ++i)
    if (folded(i, 0) > 0.3) {
      const double beyond = folded(i, 0) - 0.3;
      folded(i, 0) = 0.3 - 0.99 * beyond;
      folded(i, 2) += 0.05 + 0.1 * beyond;
    }
  all.push_back({"folded", folded, 1e-6});
  all.push_back({"near-degenerate", flattened(level, rest + noise(n, 0.01, 5), 11, 0.02), 1e-6});
  return all;
}

/// Runs the body on every energy, on a flat and, unless the energy is for flat ones alone, a curved level.
template <class Body>
void for_each_binding(const Body& body) {
  for (const Candidate& candidate : all_energies())
    for (const Level& level : {flat_level(), Level::of(0, curved_mesh())}) {
      const auto bound = bind(candidate, level);
      if (!bound) continue;
      INFO(candidate.name << " on the " << (level.rest.vertices.col(2).isZero(0) ? "flat" : "curved")
                          << " mesh");
      body(candidate, level, *bound);
    }
}

/// Runs the body in every state of these.
template <class Body>
void for_each_deformation(const Body& body) {
  for_each_binding([&](const Candidate& candidate, const Level& level, const BoundEnergy& energy) {
    for (const State& s : states(candidate, level)) {
      INFO(s.name);
      body(candidate, energy, s);
    }
  });
}

}  // namespace

TEST_CASE("An energy's gradient is that of its value", "[conformance]") {
  for_each_deformation([](const Candidate&, const BoundEnergy& energy, const State& s) {
    const Eigen::VectorXd g = flat(gradient_of(energy, s.x));
    REQUIRE(g.norm() > 0);
    const Eigen::VectorXd expected = gradient_by_differences(energy, s.x, s.step);
    const double rounding = 1e-15 * std::abs(energy.value(s.x)) / s.step * std::sqrt(g.size());
    CHECK((g - expected).norm() <= 1e-7 * g.norm() + rounding);
  });
}

TEST_CASE("An energy's Hessian is that of its gradient, and symmetric", "[conformance]") {
  for_each_deformation([](const Candidate&, const BoundEnergy& energy, const State& s) {
    const BlockMatrix matrix = hessian_of(energy, s.x, Projection::none);
    for (int i = 0; i < matrix.pattern->rows(); ++i) {
      const Eigen::Map<const Eigen::Matrix3d> diagonal(matrix.block(matrix.pattern->find(i, i)));
      REQUIRE((diagonal - diagonal.transpose()).norm() <= 1e-13 * diagonal.norm());
    }
    const Eigen::MatrixXd h = dense(matrix);
    if (energy.stencils().rows() > 0) REQUIRE(h.norm() > 0);
    const Eigen::MatrixXd expected = hessian_by_differences(energy, s.x, s.step);
    const double rounding = 1e-15 * flat(gradient_of(energy, s.x)).norm() / s.step * std::sqrt(h.rows());
    CHECK((h - expected).norm() <= 1e-7 * h.norm() + rounding);
    CHECK((expected - expected.transpose()).norm() <= 1e-7 * h.norm() + rounding);
  });
}

TEST_CASE("Projected Hessians are positive semidefinite and lie above the exact one", "[conformance]") {
  int indefinite = 0;
  for_each_deformation([&](const Candidate&, const BoundEnergy& energy, const State& s) {
    if (energy.stencils().rows() > 0) indefinite += check_projections(energy, s.x);
  });
  REQUIRE(indefinite > 0);  // else nothing was projected
}

TEST_CASE("Internal energies are invariant under rigid motions", "[conformance]") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  int internal = 0;
  for_each_deformation([&](const Candidate& candidate, const BoundEnergy& energy, const State& s) {
    if (!candidate.internal()) return;
    ++internal;
    const Positions moved = (s.x * turn.transpose()).rowwise() + Eigen::RowVector3d(0.3, -0.2, 0.7);
    REQUIRE(energy.value(s.x) > 0);
    CHECK(energy.value(moved) == Approx(energy.value(s.x)).epsilon(1e-9));
    const Positions g = gradient_of(energy, s.x) * turn.transpose();
    CHECK((gradient_of(energy, moved) - g).norm() <= 1e-9 * g.norm());
  });
  REQUIRE(internal > 0);
}

TEST_CASE("add_gradient adds, and returns the value", "[conformance]") {
  for_each_deformation([](const Candidate&, const BoundEnergy& energy, const State& s) {
    const Positions before = noise(s.x.rows(), 1, 6), g = gradient_of(energy, s.x);
    Positions sum = before;
    CHECK(energy.add_gradient(s.x, sum) == Approx(energy.value(s.x)).epsilon(1e-13));
    CHECK((sum - before - g).norm() <= 1e-13 * (g.norm() + before.norm()));
  });
}

TEST_CASE("Energies give the same bits with any number of threads", "[conformance]") {
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

TEST_CASE("The rest shape of every level of every hierarchy is stress-free", "[conformance]") {
  const std::vector<std::pair<std::string, TriangleMesh>> meshes = {
      {"grid", grid({0.6, 0.5}, 6, 5, Diagonals::one_way)},
      {"criss-cross", grid({0.6, 0.5}, 6, 5, Diagonals::criss_cross)},
      {"equilateral", equilateral({0.6, 0.5}, 6, 6)},
      {"random triangulation", random_triangulation({0.6, 0.5}, 40, 11)},
      {"disc", disc(0.4, 40)},
      {"polygon with a hole",
       delaunay_polygon({{{0, 0}, {0.8, 0}, {0.6, 0.6}, {0.1, 0.5}}, {{0.3, 0.2}, {0.5, 0.2}, {0.4, 0.35}}},
                        60, 1)},
      {"curved", curved_mesh()}};
  int checked = 0;
  for (const RegistryEntry* entry : test_registry().of_kind("refiner"))
    for (const auto& [mesh_name, mesh] : meshes) {
      const Hierarchy hierarchy = Hierarchy::of(mesh, *make_plugin_from<Refiner>(entry->name), 3);
      for (const Candidate& candidate : all_energies()) {
        if (!candidate.internal() || candidate.prestressed) continue;
        for (const Level& level : hierarchy.levels) {
          INFO(candidate.name << ", " << mesh_name << " refined by " << entry->name << ", level "
                              << level.index);
          const auto energy = bind(candidate, level);
          if (!energy) continue;
          const Positions& rest = level.rest.vertices;
          const BlockMatrix h = hessian_of(*energy, candidate.enlarged() * rest, Projection::none);
          double stiffness = 0;
          for (double entry : h.values) stiffness = std::max(stiffness, std::abs(entry));
          REQUIRE(stiffness > 0);
          CHECK(gradient_of(*energy, rest).cwiseAbs().maxCoeff() <= 1e-14 * stiffness);
          CHECK(std::abs(energy->value(rest)) <= 1e-26 * stiffness * level.triangle_count());
          ++checked;
        }
      }
    }
  REQUIRE(checked >= 2 * 6 * 3 * 3);
}

TEST_CASE("A collapsed triangle has an energy that is a number or +infinity", "[conformance]") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Level level = flat_level();
  const auto v = level.rest.triangles.row(11);
  int infinite = 0;
  for (const Candidate& candidate : all_energies()) {
    if (!candidate.internal()) continue;
    INFO(candidate.name);
    const auto energy = candidate.energy->bind(level, material);
    const auto flat_to = [&](double fraction) {
      return energy->value(flattened(level, level.rest.vertices, 11, fraction));
    };
    const bool unbounded = flat_to(1e-12) - flat_to(1e-6) > 0.1 * (flat_to(1e-6) - flat_to(1));

    std::vector<Positions> collapsed(3, level.rest.vertices);
    collapsed[0].row(v[1]) = collapsed[0].row(v[0]);
    collapsed[1].row(v[1]) = collapsed[1].row(v[2]) = collapsed[1].row(v[0]);
    collapsed[2].row(v[0]) << 0, 0, 0;  // three vertices on a line, with coordinates that round to nothing
    collapsed[2].row(v[1]) << 0.25, 0, 0;
    collapsed[2].row(v[2]) << 0.5, 0, 0;
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

TEST_CASE("A rest shape with a triangle without area is refused", "[conformance]") {
  Level level = Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way));
  level.rest.vertices.row(4) = level.rest.vertices.row(0);
  for (const Candidate& candidate : all_energies()) {
    // A spring needs its edge alone.
    if (!candidate.internal() || candidate.name.starts_with("springs")) continue;
    INFO(candidate.name);
    CHECK_THROWS_WITH(candidate.energy->bind(level, material),
                      Catch::Contains(" of level 0 has no area at rest") ||
                          Catch::Contains("the rest shape of level 0 is not flat"));
  }
}

TEST_CASE("A single triangle does not bend", "[conformance]") {
  const Level level = Level::of(0, mesh_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}));
  const Positions x = level.rest.vertices + noise(3, 0.1, 12);
  for (const Candidate& candidate : all_energies()) {
    if (candidate.energy->role() != EnergyRole::bending) continue;
    INFO(candidate.name);
    const auto energy = candidate.energy->bind(level, material);
    CHECK(energy->value(x) == 0);
    CHECK(gradient_of(*energy, x).isZero(0));
    CHECK(dense(hessian_of(*energy, x, Projection::clamp)).isZero(0));
  }
}

TEST_CASE("Energies: midpoint_factor holds on the surface split at midpoints", "[conformance]") {
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

TEST_CASE("Membranes of coarse levels have consistent derivatives, resist less and soften", "[conformance]") {
  const Level level = Level::of(0, grid({0.1, 0.1}, 2, 2, Diagonals::one_way));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  int membranes = 0, relaxed = 0;
  for (const Candidate& candidate : all_energies()) {
    if (candidate.energy->role() != EnergyRole::membrane) continue;
    ++membranes;
    INFO(candidate.name);
    const auto plain = candidate.energy->bind(level, material);
    for (const double bound : {0.0, 1e-5, 1e-3}) {
      const auto buckling = candidate.energy->bind_buckling(level, material, bound);
      CHECK(buckling->stencils() == plain->stencils());
      for (const Eigen::Vector3d& stretch :
           {Eigen::Vector3d(1.05, 1.02, 1), Eigen::Vector3d(1.05, 0.8, 1), Eigen::Vector3d(0.9, 0.8, 1),
            Eigen::Vector3d(1.2, 0.3, 1), Eigen::Vector3d(0.4, 0.3, 1)}) {
        INFO("bound " << bound << ", stretches " << stretch.transpose());
        const Positions x = level.rest.vertices * stretch.asDiagonal() * turn.transpose();
        const Eigen::VectorXd g = flat(gradient_of(*buckling, x));
        const double rounding = 1e-15 * buckling->value(x) / 1e-6 * std::sqrt(g.size());
        CHECK((g - gradient_by_differences(*buckling, x, 1e-6)).norm() <= 1e-7 * g.norm() + rounding);
        const Eigen::MatrixXd h = dense(hessian_of(*buckling, x, Projection::none));
        CHECK((h - hessian_by_differences(*buckling, x, 1e-6)).norm() <= 1e-6 * h.norm());
        const Eigen::MatrixXd clamped = dense(hessian_of(*buckling, x, Projection::clamp));
        CHECK(eigenvalues_of(clamped).minCoeff() >= -1e-12 * clamped.norm());
        CHECK(buckling->value(x) <= plain->value(x) * (1 + 1e-12));
      }
    }
    const Positions narrow = level.rest.vertices * Eigen::Vector3d(1.05, 0.8, 1).asDiagonal();
    const double own = plain->value(narrow),
                 slack = candidate.energy->bind_buckling(level, material, 0)->value(narrow);
    const bool keeps_its_law = slack == own;  // as a law with directions may
    if (!keeps_its_law) CHECK(slack < 0.5 * own);
    relaxed += !keeps_its_law;
    if (!candidate.energy->midpoint_factor()) continue;  // its law depends on sizes
    Level soft = level;
    soft.softening = Eigen::Vector2d(0.25, 0.25);
    CHECK(candidate.energy->bind_buckling(soft, material, 0.25e-3)->value(narrow) ==
          Approx(0.25 * candidate.energy->bind_buckling(level, material, 1e-3)->value(narrow)).epsilon(1e-9));
  }
  CHECK(membranes >= 2);
  CHECK(relaxed >= 4);
}

TEST_CASE("plate_stiffness is that of a sheet rolled along its grid", "[conformance]") {
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
