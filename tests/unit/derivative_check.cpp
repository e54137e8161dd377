#include "core/numerics/model/derivative_check.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/numerics/model/level_model.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

/// ¼ Σ |x_i|⁴, with an error in the gradient at one coordinate, or in the Hessian.
struct Quartic : BoundEnergy {
  int vertices = 3;
  double gradient_error = 0, hessian_error = 0, limit = std::numeric_limits<double>::infinity();

  double value(const Positions& x) const override {
    if (x(0, 0) > limit) return std::numeric_limits<double>::infinity();
    return 0.25 * x.rowwise().squaredNorm().cwiseAbs2().sum();
  }
  double add_gradient(const Positions& x, Positions& g) const override {
    for (int i = 0; i < vertices; ++i) g.row(i) += x.row(i).squaredNorm() * x.row(i);
    g(1, 2) += gradient_error;
    return value(x);
  }
  Stencils stencils() const override { return Eigen::VectorXi::LinSpaced(vertices, 0, vertices - 1); }
  void add_hessian(const Positions& x, Projection, BlockSink& sink) const override {
    for (int i = 0; i < vertices; ++i) {
      const Eigen::RowVector3d r = x.row(i);
      Eigen::Matrix<double, 3, 3, Eigen::RowMajor> h =
          r.squaredNorm() * Eigen::Matrix3d::Identity() + 2 * r.transpose() * r;
      if (i == 2) h(0, 1) += hessian_error;
      sink.add(i, 0, 0, h.data());
    }
  }
};

const Positions state = [] {
  Positions x(3, 3);
  x << 0.3, -0.2, 0.5, 0.1, 0.4, -0.6, -0.3, 0.2, 0.7;
  return x;
}();

/// A weight of 1 N a vertex, far below the origin.
struct Weight : BoundEnergy {
  double value(const Positions& x) const override { return x.col(2).sum(); }
  double add_gradient(const Positions& x, Positions& g) const override {
    g.col(2).array() += 1;
    return value(x);
  }
  Stencils stencils() const override { return Stencils(0, 1); }
  void add_hessian(const Positions&, Projection, BlockSink&) const override {}
};

/// A quartic whose add_gradient forgets what is in g, or returns another number.
struct Careless : Quartic {
  bool overwrites = false;
  double excess = 0;
  double add_gradient(const Positions& x, Positions& g) const override {
    if (overwrites) g.setZero();
    return Quartic::add_gradient(x, g) + excess;
  }
};

}  // namespace

TEST_CASE("a linear energy passes, whose differences of forces are round-off") {
  const DerivativeCheck check = check_derivatives(Weight(), state, 1e-4);
  CHECK(check.gradient.error < 1e-9);
  CHECK(check.hessian.error < 1e-6);
}

TEST_CASE("a gradient that is not added, and an energy that is another, are refused") {
  Careless energy;
  CHECK(check_derivatives(energy, state, 1e-3).gradient.error < 1e-9);
  energy.excess = 1e-3;
  CHECK_THROWS_WITH(check_derivatives(energy, state, 1e-3),
                    Catch::Matchers::StartsWith("add_gradient returns "));
  energy = {};
  energy.overwrites = true;
  CHECK_THROWS_WITH(check_derivatives(energy, state, 1e-3),
                    "add_gradient does not add to the numbers in g, but overwrites some");
}

TEST_CASE("correct derivatives have small errors") {
  const DerivativeCheck check = check_derivatives(Quartic(), state, 1e-3);
  CHECK(check.gradient.error < 1e-9);
  CHECK(check.hessian.error < 1e-9);
  CHECK(check.asymmetry == 0);
}

TEST_CASE("the largest error of a derivative is found where it is") {
  Quartic energy;
  energy.gradient_error = 0.1;
  energy.hessian_error = 0.2;
  const DerivativeCheck check = check_derivatives(energy, state, 1e-3);
  CHECK(check.gradient.error > 0.1);
  CHECK(check.gradient.row == 5);
  CHECK(check.hessian.error > 0.1);
  CHECK(check.hessian.row == 6);
  CHECK(check.hessian.column == 7);
  CHECK(check.asymmetry > 0.1);
}

TEST_CASE("a state at the border of the domain is refused") {
  Quartic energy;
  energy.limit = 0.3;
  CHECK_THROWS_WITH(check_derivatives(energy, state, 1e-3), Catch::Contains("not finite near x"));
  CHECK_THROWS_WITH(check_derivatives(energy, state, 0), Catch::Contains("a step above 0"));
}

TEST_CASE("the derivatives of a model's whole energy have limits and contacts in them") {
  const Level level = Level::of(0, random_triangulation({0.4, 0.3}, 20, 3));
  const auto stvk = make_plugin_from<Energy>("stvk");
  const auto gravity = make_plugin_from<Energy>("gravity");
  const auto limit = make_plugin_from<Energy>("{type: strain_limit, limit: 1.2}");
  const auto floor = make_plugin_from<ContactModel>(
      "{type: shapes, dhat: 0.05, obstacles: [{name: floor, shape: half_space, translate: [0, 0, -0.02], "
      "normal: [0, 0, 1]}]}");
  const LevelModel model(level, Material(), {{"stvk", stvk}, {"gravity", gravity}, {"limit", limit}}, {},
                         {floor});
  const Positions x = 1.03 * level.rest.vertices;
  Positions g;
  CHECK(model.energy_gradient(x, g) == Approx(model.energy(x)).epsilon(1e-14));
  double barrier = 0;
  for (const auto& [name, part] : model.energy_parts(x))
    if (name == "contact") barrier = part;
  REQUIRE(barrier > 0);

  const BlockMatrix hessian = model.energy_hessian(x, Projection::none);
  Positions direction = Positions::Zero(x.rows(), 3), product, forward, backward;
  for (Eigen::Index i = 0; i < direction.size(); ++i) direction.data()[i] = std::sin(3.0 * double(i) + 1);
  hessian.multiply(direction, product);
  constexpr double h = 1e-6;
  CHECK(std::isfinite(model.energy_gradient(x + h * direction, forward)));
  model.energy_gradient(x - h * direction, backward);
  const Positions expected = (forward - backward) / (2 * h);
  REQUIRE(expected.norm() > 0);
  CHECK((product - expected).norm() <= 1e-5 * expected.norm());
}
