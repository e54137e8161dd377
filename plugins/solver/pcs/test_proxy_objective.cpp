#include <catch2/catch.hpp>

#include "proxy_objective.h"
#include "tests/support/evaluate.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Three levels without pins, and a bent, stretched state of the coarsest.
struct Fixture {
  Solved s = scene_from(R"(
name: proxy
cloth: {shape: rectangle, size: [0.6, 0.5], triangulation: random, vertices: 14}
levels: 3
material: {thickness: 0.01, membrane_modulus: 1e4, bending_modulus: 1e6, poisson_ratio: 0.3}
energies: [neo_hookean, hinge, gravity]
methods: {pcs: {}}
)");
  Problem problem = s.scene->problem();

  Positions state(int level) const {
    Positions x = s.scene->hierarchy.levels[level].rest.vertices;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      x(i, 2) = 0.1 * std::sin(9 * x(i, 0)) + 0.2 * x(i, 1) * x(i, 1);
      x(i, 0) *= 1.1 + 0.3 * x(i, 1);
    }
    return x;
  }
};

}  // namespace

TEST_CASE("The proxy's energy is the finest level's at P x", "[proxy_objective]") {
  const Fixture f;
  for (int level : {0, 1}) {
    ProxyObjective proxy(f.problem, level, 1);
    const Positions x = f.state(level);
    const double expected = f.s.model().value(f.s.scene->hierarchy.prolong(x, level, 2));
    REQUIRE(std::abs(expected - f.problem.models[level]->value(x)) > 1e-3 * std::abs(expected));
    CHECK(proxy.value(x) == Approx(expected).epsilon(1e-13));
    Positions g;
    CHECK(proxy.gradient(x, g) == Approx(expected).epsilon(1e-13));
    CHECK(proxy.is_proxy());
    CHECK(&proxy.model() == f.problem.models[level]);
  }
}

TEST_CASE("The proxy's gradient is that of its value", "[proxy_objective]") {
  const Fixture f;
  for (int level : {0, 1}) {
    ProxyObjective proxy(f.problem, level, 1);
    const Positions x = f.state(level);
    Positions g;
    proxy.gradient(x, g);
    const Eigen::VectorXd expected =
        differences([&](const Positions& y) { return proxy.value(y); }, x, 1e-5).transpose();
    REQUIRE(g.norm() > 0);
    CHECK((flat(g) - expected).norm() <= 1e-8 * g.norm());
  }
}

TEST_CASE("The Galerkin matrix of the finest level is the proxy's Hessian", "[proxy_objective]") {
  const Fixture f;
  for (int level : {0, 1}) {
    ProxyObjective proxy(f.problem, level, 8);  // deeper than there are levels: as deep as there are
    const Positions x = f.state(level);
    const Eigen::MatrixXd h = dense(proxy.matrix(x, Projection::none));
    const auto gradient = [&](const Positions& y) {
      Positions g;
      proxy.gradient(y, g);
      return g;
    };
    REQUIRE(h.norm() > 0);
    CHECK((h - differences(gradient, x, 1e-5)).norm() <= 1e-8 * h.norm());
  }
}

TEST_CASE("With depth 0 the matrix is the plain model's", "[proxy_objective]") {
  const Fixture f;
  ProxyObjective proxy(f.problem, 0, 0);
  const Positions x = f.state(0);
  BlockMatrix plain(f.problem.models[0]->pattern());
  f.problem.models[0]->hessian(x, Projection::clamp, plain);
  CHECK(proxy.matrix(x, Projection::clamp).values == plain.values);
  ProxyObjective galerkin(f.problem, 0, 1);
  REQUIRE((dense(galerkin.matrix(x, Projection::clamp)) - dense(plain)).norm() > 1e-3 * dense(plain).norm());
}
