#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/kernel_check.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/pressure/pressure.cpp"

using namespace drape;

namespace {

std::unique_ptr<BoundEnergy> bound(const Level& level, double pressure) {
  Pressure p;
  p.pressure = pressure;
  return p.bind(level, Material());
}

/// A box of these lengths without those of its two faces across z that are `open`.
Level open_box(const Eigen::Vector3d& lengths, bool top_open, bool bottom_open) {
  TriangleMesh box = unit_box();
  box.vertices *= lengths.asDiagonal();
  std::vector<Eigen::RowVector3i> kept;
  for (const auto& t : box.triangles.rowwise()) {
    const Eigen::Vector3d z = box.vertices(t, 2);
    const bool across = z.maxCoeff() == z.minCoeff(), top = z.sum() > 0;
    if (!across || (top ? !top_open : !bottom_open)) kept.emplace_back(t);
  }
  box.triangles.resize(std::ssize(kept), 3);
  for (Eigen::Index t = 0; t < std::ssize(kept); ++t) box.triangles.row(t) = kept[t];
  return Level::of(0, box);
}

void check_balanced(const Positions& x, const Positions& force) {
  CHECK(force.colwise().sum().norm() <= 1e-14 * force.norm());
  Eigen::RowVector3d torque(0, 0, 0);
  for (Eigen::Index i = 0; i < x.rows(); ++i) torque += x.row(i).cross(force.row(i));
  CHECK(torque.norm() <= 1e-14 * force.norm());
}

}  // namespace

TEST_CASE("pressure: projection is that of every edge's matrix") {
  const Level level = Level::of(0, sphere_mesh(1, 0));
  const Positions x = shaken(level.rest.vertices, 0.1, 4);
  const auto energy = bound(level, -30);
  const Eigen::MatrixXd exact = dense(hessian_of(*energy, x, Projection::none));
  std::vector<Eigenpairs> edges;
  const int n = level.vertex_count();
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) {
      Eigen::MatrixXd one = Eigen::MatrixXd::Zero(3 * n, 3 * n);
      one.block<3, 3>(3 * i, 3 * j) = exact.block<3, 3>(3 * i, 3 * j);
      one.block<3, 3>(3 * j, 3 * i) = exact.block<3, 3>(3 * j, 3 * i);
      if (one.norm() > 0) edges.push_back(eigenpairs_of(one));
    }
  REQUIRE(edges.size() == 30);
  for (const auto kind : {Projection::clamp, Projection::absolute})
    for (const double blend : {1.0, 0.3}) {
      const Projection projection(kind, blend);
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * n, 3 * n);
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
  check_balanced(x, g);

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
  const Positions force = -gradient_of(*bound(level, 50), x);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (level.topology.on_border[i]) continue;
    ++inner;
    CHECK((force.row(i) - expected.row(i)).norm() <= 1e-12 * expected.norm());
  }
  REQUIRE(inner > 10);
}

TEST_CASE("pressure: an open cloth feels no net force and no torque, and the same ones wherever it is") {
  for (const Level& level : {Level::of(0, random_triangulation({0.6, 0.5}, 30, 7)),
                             open_box({0.3, 0.4, 0.5}, true, false), open_box({0.3, 0.4, 0.5}, true, true)}) {
    const Positions x = shaken(level.rest.vertices, 0.05, 6);
    const auto energy = bound(level, 50);
    const Positions force = -gradient_of(*energy, x);
    REQUIRE(force.norm() > 0.1);
    check_balanced(x, force);
    const Positions moved = x.rowwise() + Eigen::RowVector3d(0.3, -2, 5);
    CHECK(energy->value(moved) == Approx(energy->value(x)).epsilon(1e-12));
    CHECK((gradient_of(*energy, moved) + force).norm() <= 1e-12 * force.norm());
  }
}

TEST_CASE("pressure: flat openings, one or two, are closed by their planes") {
  const Eigen::Vector3d lengths(0.3, 0.4, 0.5);
  for (const auto& [top, bottom] : {std::pair(true, false), {false, true}, {true, true}}) {
    const Level box = open_box(lengths, top, bottom);
    CHECK(bound(box, 6)->value(box.rest.vertices) == Approx(-6 * lengths.prod()).epsilon(1e-14));
  }
  const Level flat = Level::of(0, grid({1, 1}, 5, 4, Diagonals::one_way));
  CHECK(std::abs(bound(flat, 6)->value(flat.rest.vertices)) <= 1e-15);
}

TEST_CASE("pressure: a disc that is held at its middle comes to the same end wherever it is") {
  const auto end = [](double at) {
    const std::string x = std::to_string(at);
    const Solved s = solve_yaml(
        "name: disc\ncloth: {shape: disc, radius: 0.1, vertices: 100}\nlevels: 1\n"
        "material: {density: 300, thickness: 4e-4, membrane_modulus: 1e6, bending_modulus: 1e6}\n"
        "start: {translate: [" +
        x +
        ", 0, 0]}\npins: [{region: nearest, point: [0, 0, 0]}, "
        "{region: nearest, point: [0.02, 0, 0]}, {region: nearest, point: [0, 0.02, 0]}]\n"
        "energies: [neo_hookean, hinge, {type: pressure, pressure: 0.5}]\n"
        "newton: {force_tolerance: 1e-6, max_steps: 500}\nmethods: {newton: {}}\n");
    INFO(s.levels[0].message);
    REQUIRE(s.levels[0].outcome == Outcome::converged);
    return Positions(s.x().rowwise() - Eigen::RowVector3d(at, 0, 0));
  };
  const Positions here = end(0);
  CHECK(here.col(2).maxCoeff() - here.col(2).minCoeff() > 0.01);
  CHECK((end(0.3) - here).rowwise().norm().maxCoeff() < 1e-5);
}
