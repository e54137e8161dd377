#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "tests/support/metric_check.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/metric/stretch/stretch.cpp"

using namespace drape;
using Eigen::Vector3d;

namespace {

MetricResult evaluate(const Level& level, const Positions& x) {
  return Stretch().evaluate({level, empty_model(), x, nullptr});
}

}  // namespace

TEST_CASE("a homogeneous stretch is reported as such, whatever the motion") {
  const Level level = square(5);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
                        map = turn * Vector3d(1.3, 0.8, 1).asDiagonal() *
                              Eigen::AngleAxisd(0.4, Vector3d::UnitZ()).toRotationMatrix();
  const Positions x = (level.rest.vertices * map.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  const MetricResult result = evaluate(level, x);
  CHECK(value(result, "largest_stretch") == Approx(1.3).epsilon(1e-12));
  CHECK(value(result, "smallest_stretch") == Approx(0.8).epsilon(1e-12));
  CHECK(value(result, "mean_stretch") == Approx(1.3).epsilon(1e-12));
  REQUIRE(result.fields.size() == 1);
  CHECK(result.fields[0].name == "stretch");
  CHECK((result.fields[0].values.array() - 1.3).abs().maxCoeff() < 1e-12);
}

TEST_CASE("one stretched triangle is found, weighed by its rest area and shown at its vertices") {
  Level level = square(1);                // triangles (0, 1, 3) and (0, 3, 2)
  level.rest.vertices.row(2) << 0, 3, 0;  // now of area 0.5 and 1.5
  Positions x = level.rest.vertices;
  x.row(1) += x.row(1) - x.row(3);  // shears and stretches (0, 1, 3) alone
  const MetricResult result = evaluate(level, x);
  // Triangle (0, 1, 3): F maps (1, 0) to (1, −1) and (0, 1) to (0, 2).
  Eigen::Matrix2d F;
  F << 1, 0, -1, 2;
  const Eigen::Vector2d expected = F.jacobiSvd().singularValues();
  CHECK(value(result, "largest_stretch") == Approx(expected[0]));
  CHECK(value(result, "smallest_stretch") == Approx(expected[1]));
  CHECK(value(result, "mean_stretch") == Approx((0.5 * expected[0] + 1.5 * 1) / 2));
  const Eigen::VectorXd& field = result.fields[0].values;
  CHECK(field[2] == Approx(1));
  for (const int i : {0, 1, 3}) CHECK(field[i] == Approx(expected[0]));
}

TEST_CASE("stretch refuses a level with a triangle without area") {
  Level level = square(2);
  level.rest.vertices.setZero();
  CHECK_THROWS_WITH(evaluate(level, level.rest.vertices),
                    Catch::Contains("triangle 0 of level 0 has no area"));
}
