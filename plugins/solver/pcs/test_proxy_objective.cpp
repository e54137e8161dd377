#include <catch2/catch.hpp>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/model/required.h"
#include "plugins/solver/pcs/proxy_objective.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Three levels without pins.
struct Fixture {
  Solved s;
  const Problem& problem;
  const LevelModel& coarse;  ///< the plain model of level 0

  explicit Fixture(const Overrides& overrides = {})
      : s(scene_from(R"(
name: proxy
cloth: {shape: rectangle, size: [0.6, 0.5], triangulation: random, vertices: 14}
levels: 3
material: {thickness: 0.01, membrane_modulus: 1e4, poisson_ratio: 0.3, bending_modulus: 1e6}
energies: [neo_hookean, hinge, gravity]
methods: {pcs: {}}
)",
                     overrides)),
        problem(*s.scene),
        coarse(*problem.models[0]) {}

  /// Bent and stretched.
  Positions state(int level = 0) const {
    Positions x = problem.hierarchy.levels[level].rest.vertices;
    for (auto p : x.rowwise()) {
      p[2] = 0.1 * std::sin(9 * p[0]) + 0.2 * p[1] * p[1];
      p[0] *= 1.1 + 0.3 * p[1];
    }
    return x;
  }
  /// The finest level's energy at the state x of a level, prolonged [J].
  double finest_value(const Positions& x, int level, const std::vector<ProlongationMatrix>& weights) const {
    return s.model().value(problem.hierarchy.prolong(x, level, 2, weights));
  }
};

constexpr ProxyInterpolation by_refiner{Interpolation::refiner, Interpolation::refiner,
                                        Interpolation::refiner, Interpolation::refiner};
constexpr ProxyInterpolation by_midpoints;
constexpr ProxyInterpolation mixed{Interpolation::midpoint, Interpolation::refiner, Interpolation::midpoint,
                                   Interpolation::midpoint};
const std::string one_way =
    "{shape: rectangle, size: [0.6, 0.5], triangulation: one_way, columns: 5, rows: 4}";

/// The proxy of a level for the finest one.
ProxyObjective proxy_of(const Problem& problem, int level, int depth,
                        const ProxyInterpolation& interpolation = by_refiner,
                        ProxyMatrix matrix = ProxyMatrix::galerkin) {
  return ProxyObjective(problem, level, {interpolation, matrix, depth, false, false});
}

Positions gradient_at(Objective& objective, const Positions& x) {
  Positions g;
  objective.gradient(x, g);
  return g;
}

/// Gradient and exact matrix against differences, each state as the start of its own step.
void check_derivatives(ProxyObjective& proxy, const Positions& x, double step, double tolerance) {
  const auto value = [&](const Positions& y) { return proxy.max_step(y, y), value_of(proxy, y); };
  const auto gradient = [&](const Positions& y) { return proxy.max_step(y, y), gradient_at(proxy, y); };
  const Eigen::VectorXd g = flat(gradient(x));
  const Eigen::MatrixXd h = dense(proxy.matrix(x, Projection::none));
  REQUIRE(g.norm() > 0);
  REQUIRE(h.norm() > 0);
  CHECK((differences(value, x, step).transpose() - g).norm() <= tolerance * g.norm());
  CHECK((differences(gradient, x, step) - h).norm() <= tolerance * h.norm());
}

}  // namespace

TEST_CASE("The proxy's energy is the finest level's at P x") {
  const Fixture f;
  for (int level : {0, 1}) {
    ProxyObjective proxy = proxy_of(f.problem, level, 1);
    const Positions x = f.state(level);
    const double expected = f.finest_value(x, level, f.problem.hierarchy.prolongations);
    REQUIRE(std::abs(expected - f.problem.models[level]->value(x)) > 1e-3 * std::abs(expected));
    CHECK(value_of(proxy, x) == Approx(expected).epsilon(1e-13));
    CHECK(proxy.is_proxy());
    CHECK(&proxy.model() == f.problem.models[level].get());
  }
}

TEST_CASE("By midpoints the proxy's energy is that of the coarse surface on the finest mesh") {
  // A grid's rest shapes are the same by Loop and by midpoints, so that the finest model has this surface.
  const std::string bending = GENERATE("hinge", "midedge_bending");
  const Fixture f(
      Overrides{{"cloth", one_way},
                {"energies", "[neo_hookean, " + bending + ", gravity, {type: pressure, pressure: 20}]"}});
  const double tolerance = bending == "hinge" ? 1e-11 : 0.01;  // midedge_bending counts borders nearly
  for (int level : {0, 1}) {
    const Positions x = f.state(level);
    ProxyObjective proxy = proxy_of(f.problem, level, 1, by_midpoints);
    const double expected = f.finest_value(x, level, f.problem.hierarchy.midpoints);
    REQUIRE(std::abs(expected - f.problem.models[level]->value(x)) > 1e-3 * std::abs(expected));
    CHECK(value_of(proxy, x) == Approx(expected).epsilon(tolerance));
    CHECK(proxy.has_exact_hessian());  // nothing is evaluated on another level
    CHECK(proxy.matrix(x, Projection::clamp).pattern == f.problem.models[level]->pattern());
  }
}

TEST_CASE("Energies of one role without a common factor are evaluated on the finest mesh by midpoints") {
  const Fixture f(Overrides{{"energies", "[neo_hookean, hinge, midedge_bending, gravity]"}});
  const auto parts = proxy_parts(f.problem, 0, *f.problem.model(0),
                                 Fineness::of(f.problem.hierarchy, 0).levels, {by_midpoints});
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].above == 0);
  CHECK(parts[1].above == 2);
  CHECK(parts[1].interpolation == &f.problem.hierarchy.linear);
  CHECK(parts[1].roles.has(EnergyRole::bending));
  CHECK_FALSE(parts[1].roles.has(EnergyRole::membrane));
}

TEST_CASE("The proxy's gradient is that of its value, and the finest level's Galerkin matrix its Hessian") {
  const Fixture f;
  const ProxyInterpolation interpolation = GENERATE(by_refiner, by_midpoints, mixed);
  for (int level : {0, 1}) {
    // Deeper than there are levels: as deep as there are.
    ProxyObjective proxy = proxy_of(f.problem, level, 8, interpolation);
    check_derivatives(proxy, f.state(level), 1e-5, 1e-8);
  }
}

TEST_CASE("The gradient of energies that are evaluated on a curved finest mesh goes through its offsets") {
  const Scratch folder;
  write_mesh(folder / "cap.obj", hemisphere(150));
  const Fixture f(Overrides{{"cloth", "{shape: file, file: " + (folder / "cap.obj").string() + "}"},
                            {"levels", "1"},
                            {"hierarchy", "{coarsen: 2}"},
                            {"energies", "[neo_hookean, midedge_bending]"}});
  REQUIRE_FALSE(f.problem.hierarchy.offsets[0].triangle.empty());
  for (const ProxyInterpolation& interpolation : {by_refiner, by_midpoints}) {
    ProxyObjective proxy = proxy_of(f.problem, 0, 8, interpolation);
    const Positions& rest = f.coarse.level().rest.vertices;
    CHECK(std::abs(value_of(proxy, rest)) < 1e-12);
    Positions x = rest;
    for (auto p : x.rowwise()) p[2] *= 1 + 2 * p[0], p[0] += .3 * p[1] * p[1];
    const auto value = [&](const Positions& y) { return proxy.max_step(y, y), value_of(proxy, y); };
    proxy.max_step(x, x);
    const Eigen::VectorXd g = flat(gradient_at(proxy, x));
    CHECK((differences(value, x, 1e-6).transpose() - g).norm() <= 1e-7 * g.norm());
  }
}

TEST_CASE("The coarse matrix is the plain model's") {
  const Fixture f;
  ProxyObjective proxy = proxy_of(f.problem, 0, 1, by_refiner, ProxyMatrix::coarse),
                 galerkin = proxy_of(f.problem, 0, 1);
  PlainObjective plain(f.coarse);
  const Positions x = f.state();
  const BlockMatrix& expected = plain.matrix(x, Projection::clamp);
  CHECK(proxy.matrix(x, Projection::clamp).values == expected.values);
  const Eigen::MatrixXd h = dense(expected);
  REQUIRE((dense(galerkin.matrix(x, Projection::clamp)) - h).norm() > 1e-3 * h.norm());
}

TEST_CASE("A proxy that relaxes switches to the plain energy of its level, once") {
  const Fixture f;
  const ProxyInterpolation interpolation = GENERATE(by_refiner, by_midpoints);
  const Positions x = f.state();
  ProxyObjective never = proxy_of(f.problem, 0, 1, interpolation);
  CHECK_FALSE(never.switch_to_plain());
  CHECK(never.is_proxy());
  ProxyObjective proxy(f.problem, 0, {interpolation, ProxyMatrix::galerkin, 1, false, true});
  PlainObjective plain(f.coarse);
  const Positions expected = gradient_at(plain, x);
  REQUIRE((gradient_at(proxy, x) - expected).norm() > 1e-3 * expected.norm());
  proxy.matrix(x, Projection::clamp);
  REQUIRE(proxy.switch_to_plain());
  CHECK_FALSE(proxy.switch_to_plain());
  CHECK_FALSE(proxy.is_proxy());
  CHECK(value_of(proxy, x) == value_of(plain, x));
  CHECK(gradient_at(proxy, x) == expected);
  const BlockMatrix& matrix = proxy.matrix(x, Projection::clamp);
  CHECK(matrix.pattern == f.coarse.pattern());
  CHECK(matrix.values == plain.matrix(x, Projection::clamp).values);
}

TEST_CASE("The proxy has the contact and the limits of its own level") {
  const Fixture f(Overrides{{"cloth.size", "[0.3, 0.25]"},
                            {"material", "{thickness: 1e-3, membrane_modulus: 1e3, bending_modulus: 1e5}"},
                            {"start", "{translate: [0, 0, 0.01]}"},
                            {"energies", "[neo_hookean, hinge, {type: strain_limit, limit: 1.3}, gravity]"},
                            {"contact", "shapes"},
                            {"obstacles", "[{name: floor, shape: half_space}]"}});
  ProxyObjective proxy = proxy_of(f.problem, 0, 8);
  Positions x = f.coarse.level().rest.vertices;
  for (auto p : x.rowwise()) {
    p[0] *= 1.1;
    p[2] = 0.5e-3 + 2e-4 * std::sin(30 * p[0] + 20 * p[1]);
  }
  const double shell = f.finest_value(x, 0, f.problem.hierarchy.prolongations);
  const double barrier = collisions_at(*f.coarse.contacts()[0], x)->value(x);
  const double limit = f.coarse.limits()[0]->value(x);
  REQUIRE(barrier > 0);
  REQUIRE(limit > 0);
  proxy.max_step(x, x);
  CHECK(value_of(proxy, x) == Approx(shell + barrier + limit).epsilon(1e-12));
  check_derivatives(proxy, x, 1e-6, 1e-6);
}

TEST_CASE("Membranes of coarse levels buckle below the mesh, before the proxy relaxes and after") {
  const Fixture f(Overrides{{"material.bending_modulus", "1e4"}});
  const LevelModel buckling = f.coarse.with_effective_membranes(2);
  Positions x = f.state();
  x.col(0) *= 0.6;
  REQUIRE(buckling.value(x, {EnergyRole::membrane}) < 0.5 * f.coarse.value(x, {EnergyRole::membrane}));
  ProxyObjective proxy(f.problem, 0, {by_midpoints, ProxyMatrix::galerkin, 1, true, true});
  const double bending = f.coarse.value(x, {EnergyRole::bending});
  REQUIRE(bending > 1e-4 * std::abs(buckling.value(x)));
  CHECK(value_of(proxy, x) == Approx(buckling.value(x) + 3 * bending).epsilon(1e-12));
  REQUIRE(proxy.switch_to_plain());
  CHECK(proxy.is_proxy());
  PlainObjective expected(buckling);
  CHECK(value_of(proxy, x) == value_of(expected, x));
  CHECK(gradient_at(proxy, x) == gradient_at(expected, x));
  CHECK(proxy.matrix(x, Projection::clamp).values == expected.matrix(x, Projection::clamp).values);
  // Seen by the refiner, membranes are the finest level's.
  ProxyObjective by_loop(f.problem, 0, {by_refiner, ProxyMatrix::galerkin, 1, true, false}),
      plain = proxy_of(f.problem, 0, 1);
  CHECK(value_of(by_loop, x) == value_of(plain, x));
}

TEST_CASE("A proxy follows a midpoint factor that a schedule takes away, as a resumed one does") {
  const Fixture f(Overrides{
      {"cloth", one_way},
      {"energies",
       "[neo_hookean, gravity, {type: formula, name: plastic, per: hinge, constants: {crease: 0}, "
       "energy: \"3*k*length^2/area*(bend - crease)^2\"}]"},
      {"schedule",
       "{steps: 1, keys: [{parameter: energies.plastic.crease, times: [0, 1], values: [0, 0.3]}]}"}});
  const Positions x = f.state();
  LoadStepping& load = *f.problem.load_stepping;
  load.begin(0, true);
  ProxyObjective proxy(f.problem, 0, ProxyOptions());
  proxy.matrix(x, Projection::clamp);
  while (!load.finished()) load.advance(0, x);
  proxy.set_model(f.problem.model(0), x, x);
  ProxyObjective resumed(f.problem, 0, ProxyOptions());  // made under the load of a checkpoint
  CHECK(value_of(proxy, x) == value_of(resumed, x));
  CHECK(dense(proxy.matrix(x, Projection::clamp)) == dense(resumed.matrix(x, Projection::clamp)));
}
