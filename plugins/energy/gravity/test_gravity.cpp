#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"
#include "tests/support/evaluate.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/gravity/gravity.cpp"

using namespace drape;

TEST_CASE("gravity: a cloth's potential and weight") {
  const Level level = Level::of(0, grid({2, 3}, 17, 9, Diagonals::one_way));
  Material material;
  material.density = 500;
  material.thickness = 2e-4;
  const double mass = 2 * 3 * 500 * 2e-4;
  ::Gravity parameters;
  parameters.acceleration << 0.1, -0.2, -9.81;
  const auto bound = VertexFormula<formulas::gravity>(parameters).bind(level, material);
  CHECK(bound->stencils().rows() == 0);

  // The cloth's centre is at (1, 1.5); lifted by 5.
  const Positions x = level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 5);
  CHECK(bound->value(x) == Approx(-mass * (0.1 * 1 - 0.2 * 1.5 - 9.81 * 5)).epsilon(1e-12));
  const Eigen::RowVector3d force = -gradient_of(*bound, x).colwise().sum();
  CHECK((force - mass * parameters.acceleration.transpose()).norm() <= 1e-12 * mass);
}
