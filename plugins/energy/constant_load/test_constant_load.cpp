#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"
#include "tests/support/evaluate.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/constant_load/constant_load.cpp"

using namespace drape;

TEST_CASE("constant_load: forces by area and on the nearest vertex") {
  const Level level = Level::of(0, grid({2, 3}, 5, 4, Diagonals::one_way));
  ConstantLoad load;
  load.force_density << 1, 2, -4;
  load.points = {{{2.1, 3.2, 0.5}, {0, 0, 8}}, {{0.55, 0.9, 0}, {3, 0, 0}}, {{2, 3, 0}, {0, 1, 0}}};
  const auto bound = load.bind(level, Material());
  const Positions g = gradient_of(*bound, level.rest.vertices);
  Positions expected = -level.vertex_area * load.force_density.transpose();
  expected.row(19) -= Eigen::RowVector3d(0, 1, 8);  // the corner (2, 3)
  expected.row(6) -= Eigen::RowVector3d(3, 0, 0);   // (0.5, 1)
  CHECK((g - expected).rowwise().norm().maxCoeff() <= 1e-14);
  CHECK(bound->value(level.rest.vertices) ==
        Approx(g.cwiseProduct(level.rest.vertices).sum()).epsilon(1e-13));
  CHECK(bound->stencils().rows() == 0);
}
