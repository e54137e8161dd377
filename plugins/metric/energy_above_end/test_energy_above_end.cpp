#include <catch2/catch.hpp>
#include <limits>

#include "core/kernel/interfaces/metric.h"
#include "tests/support/metric_check.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Draped by nothing but its weight, with a limit on its stretch, above a floor.
struct Fixture {
  Solved s = scene_from(R"(
name: above
cloth: {shape: rectangle, size: [0.3, 0.25], columns: 5, rows: 4}
levels: 1
start: {translate: [0, 0, 0.01]}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.3}, gravity]
contact: shapes
obstacles: [{name: floor, shape: half_space}]
methods: {newton: {}}
)");

  double above(const Positions& other, const Positions& end) const {
    return value(make_plugin_from<Metric>("energy_above_end")->evaluate({s.level(), s.model(), end, &other}),
                 "energy_above_end");
  }
  Positions lifted(double height, double stretch = 1) const {
    return (s.rest() * Eigen::Vector3d(stretch, 1, 1).asDiagonal()).rowwise() +
           Eigen::RowVector3d(0, 0, height);
  }
};

}  // namespace

TEST_CASE("A cloth that is lifted lies higher by its weight times the way") {
  const Fixture f;
  const double weight = f.s.model().masses().sum() * 9.81;
  CHECK(f.above(f.lifted(0.03), f.lifted(0.01)) == Approx(weight * 0.02).epsilon(1e-9));
  CHECK(f.above(f.lifted(0.01), f.lifted(0.03)) == Approx(-weight * 0.02).epsilon(1e-9));
  // Within reach of the floor, and beneath it: contact is not counted.
  CHECK(f.above(f.lifted(-0.01), f.lifted(0.01)) == Approx(-weight * 0.02).epsilon(1e-9));
}

TEST_CASE("The strain limit is in the energy, and infinite beyond") {
  const Fixture f;
  const Positions end = f.lifted(0.01), near = f.lifted(0.01, 1.29);
  double parts = 0;
  for (const BoundEnergy* limit : f.s.model().limits()) parts += limit->value(near);
  REQUIRE(parts > 0);
  CHECK(f.above(near, end) == Approx(f.s.model().value(near) - f.s.model().value(end) + parts).epsilon(1e-9));
  CHECK(f.above(f.lifted(0.01, 1.31), end) == std::numeric_limits<double>::infinity());
}
