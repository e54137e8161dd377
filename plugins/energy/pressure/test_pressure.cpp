#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/kernel_check.h"
#include "tests/support/meshes.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/pressure/pressure.cpp"

using namespace drape;

namespace {

const Eigen::Vector3d apex(0.2, 0.3, -0.4);

std::unique_ptr<BoundEnergy> bound(const Level& level, double pressure,
                                   const Eigen::Vector3d& centre = apex) {
  Pressure p;
  p.pressure = pressure;
  p.centre = centre;
  return p.bind(level, Material());
}

}  // namespace

TEST_CASE("pressure: projection is that of every edge's matrix") {
  const Level level = Level::of(0, grid({1, 1}, 2, 2, Diagonals::one_way));
  const Positions x = shaken(level.rest.vertices, 0.1, 4);
  const auto energy = bound(level, -30);
  const Eigen::MatrixXd exact = dense(hessian_of(*energy, x, Projection::none));
  std::vector<Eigenpairs> edges;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      Eigen::MatrixXd one = Eigen::MatrixXd::Zero(12, 12);
      one.block<3, 3>(3 * i, 3 * j) = exact.block<3, 3>(3 * i, 3 * j);
      one.block<3, 3>(3 * j, 3 * i) = exact.block<3, 3>(3 * j, 3 * i);
      if (one.norm() > 0) edges.push_back(eigenpairs_of(one));
    }
  REQUIRE(edges.size() == 5);
  for (const auto kind : {Projection::clamp, Projection::absolute})
    for (const double blend : {1.0, 0.3}) {
      const Projection projection(kind, blend);
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(12, 12);
      for (const Eigenpairs& edge : edges) expected += recomposed(edge, projection);
      CHECK((dense(hessian_of(*energy, x, projection)) - expected).norm() <= 1e-12 * exact.norm());
    }
}

TEST_CASE("pressure: a closed mesh feels no net force and no torque, wherever it is, and has its volume") {
  const Level level = Level::of(0, sphere_mesh(0.3, 1));
  const Positions x = shaken(level.rest.vertices, 0.05, 5);
  const auto energy = bound(level, 100);
  CHECK(energy->value(x) == Approx(-100 * volume_of({x, level.rest.triangles})).epsilon(1e-13));
  const Positions g = gradient_of(*energy, x);
  CHECK(g.colwise().sum().norm() <= 1e-14 * g.norm());
  Eigen::RowVector3d torque(0, 0, 0);
  for (Eigen::Index i = 0; i < x.rows(); ++i) torque += x.row(i).cross(g.row(i));
  CHECK(torque.norm() <= 1e-14 * g.norm());

  // Translated by 1 km on a common grid of doubles: no digits are lost.
  Positions rounded = (x * 1048576).array().round().matrix() / 1048576, away = rounded;
  away.rowwise() += Eigen::RowVector3d(1024, -512, 256);
  CHECK(energy->value(away) == energy->value(rounded));
  CHECK(gradient_of(*energy, away) == gradient_of(*energy, rounded));

  const Positions& ball = level.rest.vertices;
  const Positions force = -gradient_of(*energy, ball);
  for (Eigen::Index i = 0; i < ball.rows(); ++i)  // along the normal
    CHECK(force.row(i).dot(ball.row(i)) > 0.99 * force.row(i).norm() * 0.3);
}

TEST_CASE("pressure: inner vertices of an open cloth carry a third of the area around them") {
  const Level level = Level::of(0, random_triangulation({0.6, 0.5}, 30, 7));
  const Positions x = shaken(level.rest.vertices, 0.02, 6);
  Positions expected = Positions::Zero(x.rows(), 3);
  for (const auto& v : level.rest.triangles.rowwise()) {
    const Eigen::RowVector3d e1 = x.row(v[1]) - x.row(v[0]), e2 = x.row(v[2]) - x.row(v[0]);
    for (int k = 0; k < 3; ++k) expected.row(v[k]) += 50 * e1.cross(e2) / 6;
  }
  int inner = 0;
  for (const Eigen::Vector3d& centre : {apex, Eigen::Vector3d(-3, 2, 5)}) {
    const Positions force = -gradient_of(*bound(level, 50, centre), x);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      if (level.topology.on_border[i]) continue;
      ++inner;
      CHECK((force.row(i) - expected.row(i)).norm() <= 1e-12 * expected.norm());
    }
  }
  REQUIRE(inner > 10);
}

TEST_CASE("pressure: a flat cloth in one plane with the centre is pushed across it, by a third of p A") {
  const Level level = Level::of(0, grid({1, 1}, 5, 4, Diagonals::one_way));
  for (const Eigen::Vector3d& centre : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, 0.7, 0)}) {
    const Positions force = -gradient_of(*bound(level, 6, centre), level.rest.vertices);
    CHECK(force.leftCols<2>().norm() <= 1e-14);
    CHECK(force.col(2).sum() == Approx(2));
  }
}
