#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>

#include "plugins/metric/stretch/principal_stretch.h"
#include "plugins/metric/stretch/stretch.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

Level square(int n) {
  TriangleMesh mesh{Positions((n + 1) * (n + 1), 3), Triangles(2 * n * n, 3)};
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) mesh.vertices.row(i * (n + 1) + j) << double(i) / n, double(j) / n, 0;
  for (int i = 0, t = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.row(t++) << a, b, b + 1;
      mesh.triangles.row(t++) << a, b + 1, a + 1;
    }
  return Level::of(0, mesh);
}

const LevelModel& no_model() {
  alignas(64) static const char nothing[64] = {};
  return reinterpret_cast<const LevelModel&>(nothing);
}

MetricResult evaluate(const Level& level, const Positions& x) {
  return Stretch(Stretch::Parameters()).evaluate({level, no_model(), x, nullptr});
}

double value(const MetricResult& result, const std::string& name) {
  for (const MetricValue& v : result.values)
    if (v.name == name) return v.value;
  FAIL("no value named " << name);
  return 0;
}

}  // namespace

TEST_CASE("principal stretches are the singular values of F", "[stretch]") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto point = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d X0 = point(), X1 = point(), X2 = point(), x0 = point(), x1 = point(), x2 = point();
    // F = [x1 − x0, x2 − x0] [X1 − X0, X2 − X0]⁺ has the two stretches and a zero.
    Eigen::Matrix<double, 3, 2> rest, deformed;
    rest << X1 - X0, X2 - X0;
    deformed << x1 - x0, x2 - x0;
    const Eigen::Matrix3d F = deformed * (rest.transpose() * rest).inverse() * rest.transpose();
    const Vector3d expected = F.jacobiSvd().singularValues();
    const PrincipalStretches s = principal_stretches(X0, X1, X2, x0, x1, x2);
    CHECK(s.largest == Approx(expected[0]).epsilon(1e-8));
    CHECK(s.smallest == Approx(expected[1]).epsilon(1e-8));
  }
}

TEST_CASE("principal stretches lose no digits where they agree or vanish", "[stretch]") {
  const Vector3d a(0, 0, 0), b(1, 0, 0), c(0.3, 0.8, 0);
  const PrincipalStretches rest = principal_stretches(a, b, c, a, b, c);
  CHECK(std::abs(rest.largest - 1) < 1e-15);
  CHECK(std::abs(rest.smallest - 1) < 1e-15);
  const Vector3d nearly(1 + 1e-10, 1, 1);
  const PrincipalStretches near =
      principal_stretches(a, b, c, a, b.cwiseProduct(nearly), c.cwiseProduct(nearly));
  CHECK(near.largest - 1 == Approx(1e-10).epsilon(1e-4));
  CHECK(std::abs(near.smallest - 1) < 1e-14);
  const Vector3d flat(2, 1e-9, 1);
  const PrincipalStretches thin = principal_stretches(a, b, c, a, b.cwiseProduct(flat), c.cwiseProduct(flat));
  CHECK(thin.largest == Approx(2));
  CHECK(thin.smallest == Approx(1e-9).epsilon(1e-9));
  const PrincipalStretches collapsed = principal_stretches(a, b, c, a, a, a);
  CHECK(collapsed.largest == 0);
  CHECK(collapsed.smallest == 0);
}

TEST_CASE("a homogeneous stretch is reported as such, whatever the motion", "[stretch]") {
  const Level level = square(5);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  Eigen::Matrix3d F = Eigen::Vector3d(1.3, 0.8, 1).asDiagonal();
  const Eigen::Matrix3d map = turn * F * Eigen::AngleAxisd(0.4, Vector3d::UnitZ()).toRotationMatrix();
  const Positions x = (level.rest.vertices * map.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  const MetricResult result = evaluate(level, x);
  CHECK(value(result, "largest_stretch") == Approx(1.3).epsilon(1e-12));
  CHECK(value(result, "smallest_stretch") == Approx(0.8).epsilon(1e-12));
  CHECK(value(result, "mean_stretch") == Approx(1.3).epsilon(1e-12));
  REQUIRE(result.fields.size() == 1);
  CHECK(result.fields[0].name == "stretch");
  CHECK((result.fields[0].values.array() - 1.3).abs().maxCoeff() < 1e-12);
}

TEST_CASE("one stretched triangle is found, weighed by its rest area and shown at its vertices",
          "[stretch]") {
  Level level = square(1);                // triangles (0, 2, 3) and (0, 3, 1)
  level.rest.vertices.row(1) << 0, 3, 0;  // now of area 0.5 and 1.5
  Positions x = level.rest.vertices;
  x.row(2) += x.row(2) - x.row(3);  // shears and stretches (0, 2, 3) alone
  const MetricResult result = evaluate(level, x);
  // Triangle (0, 2, 3): F maps (1, 0) to (1, −1) and (0, 1) to (0, 2).
  Eigen::Matrix2d F;
  F << 1, 0, -1, 2;
  const Eigen::Vector2d expected = F.jacobiSvd().singularValues();
  CHECK(value(result, "largest_stretch") == Approx(expected[0]));
  CHECK(value(result, "smallest_stretch") == Approx(expected[1]));
  CHECK(value(result, "mean_stretch") == Approx((0.5 * expected[0] + 1.5 * 1) / 2));
  const Eigen::VectorXd& field = result.fields[0].values;
  CHECK(field[1] == Approx(1));
  for (const int i : {0, 2, 3}) CHECK(field[i] == Approx(expected[0]));
}

TEST_CASE("stretch refuses what it cannot measure", "[stretch]") {
  const Level level = square(2);
  Positions x = level.rest.vertices;
  CHECK(Stretch(Stretch::Parameters()).scope() == MetricScope::state);
  CHECK_THROWS_WITH(evaluate(level, x.topRows(3)), Catch::Contains("3 vertices, the level 9"));
  x(4, 2) = std::nan("");
  CHECK_THROWS_WITH(evaluate(level, x), Catch::Contains("not finite"));
  Level degenerate = level;
  degenerate.rest.vertices.setZero();
  CHECK_THROWS_WITH(evaluate(degenerate, level.rest.vertices), Catch::Contains("rest triangle 0"));
}
