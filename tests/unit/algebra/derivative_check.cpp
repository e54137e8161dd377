#include "core/numerics/model/derivative_check.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

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
