#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/elements/stretch.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/energy/midedge_bending/shape_operators.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/kernel_check.h"
#include "tests/support/meshes.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/midedge_bending/midedge_bending.cpp"

using namespace drape;

namespace {

constexpr double k = 0.7, nu = 0.3;
const double default_tolerance = MidedgeBending().correction_tolerance;

/// Material with this k and ν.
const Material material = [] {
  Material m;
  m.thickness = 0.01;
  m.poisson_ratio = nu;
  m.bending_modulus = k * 24 * (1 - nu * nu) / 1e-6;
  return m;
}();

std::unique_ptr<BoundEnergy> bind(const Level& level) { return MidedgeBending().bind(level, material); }

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// Of about n × n vertices on 0.6 × 0.5 m.
std::vector<NamedMesh> triangulations(int n) {
  const Eigen::Vector2d size(0.6, 0.5);
  const Eigen::Vector2i counts = equilateral_counts(size, n * n);
  return {{"one_way", grid(size, n, n, Diagonals::one_way)},
          {"criss_cross", grid(size, n, n, Diagonals::criss_cross)},
          {"equilateral", equilateral(size, counts.x(), counts.y())},
          {"random", random_triangulation(size, n * n, 7)}};
}

double angle_at(const Level& level, const Positions& x, int hinge) {
  Eigen::Vector3d d[3];
  for (int i = 0; i < 3; ++i)
    d[i] = (x.row(level.hinges(hinge, i + 1)) - x.row(level.hinges(hinge, 0))).transpose();
  return DihedralAngle<double>(d).angle();
}

/// What has the energy of a triangle as its squared norm, by the operators of the level [√J].
Eigen::Vector3d bend_of(const ShapeOperators& operators, const Level& level, const Positions& x, int t) {
  Eigen::Vector3d s = Eigen::Vector3d::Zero();
  for (const auto& [hinge, weight] : operators.terms.row(t))
    s += weight * (angle_at(level, x, hinge) - angle_at(level, level.rest.vertices, hinge));
  return s;
}

/// Energies per rest area [J/m²] of triangles without a border vertex.
std::vector<double> inner_densities(const Level& level, const Positions& x, double tolerance,
                                    const Material& of = material) {
  const ShapeOperators operators = ShapeOperators::of(level, of, tolerance);
  std::vector<double> densities;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    bool inner = true;
    for (int i = 0; i < 3; ++i) inner &= !level.topology.on_border[v[i]];
    if (inner)
      densities.push_back(bend_of(operators, level, x, t).squaredNorm() / RestTriangle::of(level, t).area);
  }
  REQUIRE(densities.size() > 10);
  return densities;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Of a plate with the curvatures of shape.
double plate_density(const Eigen::Matrix2d& shape) {
  return k * ((1 - nu) * (shape * shape).trace() + nu * shape.trace() * shape.trace());
}

/// Largest relative deviation of `values` from `expected`.
double largest_miss(const std::vector<double>& values, double expected) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v / expected - 1));
  return largest;
}

std::vector<Eigen::Matrix2d> shapes() {
  std::vector<Eigen::Matrix2d> all(6);
  all[0] << 1, 0, 0, 0;  // cylinders
  all[1] << .5, .5, .5, .5;
  all[2] << .5, -.5, -.5, .5;
  all[3] << 1, 0, 0, 1;   // a sphere
  all[4] << 1, 0, 0, -1;  // saddles
  all[5] << 0, 1, 1, 0;
  return all;
}

constexpr double small_curvature = 1e-4;  // [1/m]

/// A flat mesh with `small_curvature` times this matrix as the curvatures of its surface.
Positions bent(const TriangleMesh& mesh, const Eigen::Matrix2d& shape) {
  Positions x = mesh.vertices;
  for (auto vertex : x.rowwise()) {
    const Eigen::Vector2d p = vertex.head<2>().transpose();
    vertex[2] = small_curvature / 2 * p.dot(shape * p);
  }
  return x;
}

/// A flat mesh in waves of this height [m].
Positions wavy(const TriangleMesh& mesh, double height) {
  Positions x = mesh.vertices;
  for (auto vertex : x.rowwise()) vertex[2] = height * std::sin(7 * vertex[0]) * std::cos(5 * vertex[1] + 1);
  return x;
}

}  // namespace

TEST_CASE(
    "midedge_bending: every inner triangle of every triangulation has the plate's energy on quadratics") {
  for (const auto& [name, mesh] : triangulations(12)) {
    const Level level = Level::of(0, mesh);
    for (const Eigen::Matrix2d& shape : shapes()) {
      const Positions x = bent(mesh, shape);
      INFO(name << ", shape\n" << shape);
      const double expected = small_curvature * small_curvature * plate_density(shape);
      CHECK(largest_miss(inner_densities(level, x, 0), expected) < 1e-6);
      CHECK(mean_of(inner_densities(level, x, default_tolerance)) == Approx(expected).epsilon(0.005));
    }
  }
}

TEST_CASE("midedge_bending: the rigidity by direction is the plate's on every triangulation") {
  Material woven = material;
  woven.warp_bending = 3, woven.weft_bending = 0.5, woven.bias_bending = 0.8;
  const OrthotropicStiffness c = plate_stiffness(woven);
  CHECK(c.strip(0) == Approx(3));
  CHECK(c.strip(M_PI / 2) == Approx(0.5));
  CHECK(c.strip(M_PI / 4) == Approx(0.8));
  const double grain = 25;
  const Eigen::Rotation2Dd to_warp(-grain * M_PI / 180);
  for (auto& [name, mesh] : triangulations(12)) {
    mesh.warp = warp_at(mesh, grain);
    const Level level = Level::of(0, mesh);
    for (const Eigen::Matrix2d& shape : shapes()) {
      const Positions x = bent(mesh, shape);
      const Eigen::Matrix2d own = to_warp.toRotationMatrix() * shape * to_warp.toRotationMatrix().transpose();
      const double expected = small_curvature * small_curvature *
                              (0.5 * (c.c11 * own(0, 0) * own(0, 0) + c.c22 * own(1, 1) * own(1, 1)) +
                               c.c12 * own(0, 0) * own(1, 1) + 2 * c.c66 * own(0, 1) * own(0, 1));
      INFO(name << ", shape\n" << shape);
      CHECK(largest_miss(inner_densities(level, x, 0, woven), expected) < 1e-6);
    }
  }
}

TEST_CASE("midedge_bending: equal rigidities are the isotropic plate, and a quarter turn changes nothing") {
  Material isotropic = material, woven = material;
  const double strip = 2 * k * (1 - nu * nu);
  isotropic.warp_bending = isotropic.weft_bending = isotropic.bias_bending = strip;
  woven.warp_bending = 3, woven.weft_bending = 0.5, woven.bias_bending = 0.8;
  for (auto& [name, mesh] : triangulations(8)) {
    INFO(name);
    const Level level = Level::of(0, mesh);
    const Positions x = wavy(mesh, 0.1);
    const double plain = bind(level)->value(x);
    CHECK(std::abs(MidedgeBending().bind(level, isotropic)->value(x) / plain - 1) < 1e-12);

    Eigen::Matrix3d turn;
    turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    TriangleMesh turned = mesh;
    turned.vertices = mesh.vertices * turn.transpose();
    turned.warp = warp_at(turned, 90);
    const double own = MidedgeBending().bind(level, woven)->value(x),
                 after = MidedgeBending().bind(Level::of(0, turned), woven)->value(x * turn.transpose());
    CHECK(std::abs(own / plain - 1) > 0.1);
    CHECK(std::abs(after / own - 1) < 1e-12);
  }
}

TEST_CASE("midedge_bending: friction adds its moment to a bent strip's, and derivatives follow") {
  Material rubbing = material;
  const double rigidity = 2 * k * (1 - nu * nu), moment = 0.4, sliding = MidedgeBending().sliding_curvature;
  rubbing.bending_hysteresis = 2 * moment;
  for (auto& [name, mesh] : triangulations(5)) {
    INFO(name);
    const Level level = Level::of(0, mesh);
    const auto own = MidedgeBending().bind(level, rubbing);
    CHECK(own->value(mesh.vertices) == 0);
    for (const double height : {1e-4, 0.01, 0.1}) {  // sticking to sliding
      const Positions x = wavy(mesh, height);
      const ShapeOperators operators = ShapeOperators::of(level, rubbing, default_tolerance);
      double expected = 0;
      for (int t = 0; t < level.triangle_count(); ++t) {
        const double elastic = bend_of(operators, level, x, t).squaredNorm(),
                     area = RestTriangle::of(level, t).area,
                     curvature = std::sqrt(2 * elastic / (rigidity * area));  // of the strip
        expected += elastic + area * moment * (std::hypot(curvature, sliding) - sliding);
      }
      CHECK(own->value(x) == Approx(expected));
      CHECK(own->value(x) > bind(level)->value(x));
      const Positions g = gradient_of(*own, x);
      CHECK((gradient_by_differences(*own, x, 1e-5) - flat(g)).norm() <= 1e-6 * g.norm());
      const Eigen::MatrixXd h = dense(hessian_of(*own, x, Projection::none));
      CHECK((hessian_by_differences(*own, x, 1e-5) - h).norm() <= 1e-5 * h.norm());
      const Eigen::VectorXd clamped = eigenvalues_of(dense(hessian_of(*own, x, Projection::clamp)));
      CHECK(clamped.minCoeff() > -1e-10 * clamped.maxCoeff());
    }
  }
  Material limp = rubbing;
  limp.bending_modulus = 0;
  CHECK_THROWS_WITH(MidedgeBending().bind(Level::of(0, triangulations(5)[0].mesh), limp),
                    Catch::Contains("\"bending_hysteresis\" needs a bending rigidity"));
}

TEST_CASE("midedge_bending: a bias rigidity that no plate has is refused with its eigenvalue") {
  Material woven = material;
  woven.warp_bending = 1, woven.weft_bending = 1, woven.bias_bending = 10;
  CHECK_THROWS_WITH(MidedgeBending().bind(Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way)), woven),
                    Catch::Contains("not positive definite") && Catch::Contains("eigenvalue -1"));
}

TEST_CASE("midedge_bending: the average of the triangles' normals alone is not the plate's") {
  const Level level = Level::of(0, grid({0.6, 0.6}, 12, 12, Diagonals::criss_cross));
  const Eigen::Matrix2d saddle = shapes()[5];
  const double expected = small_curvature * small_curvature * plate_density(saddle);
  for (const double d : inner_densities(level, bent(level.rest, saddle), 1))
    CHECK(d / expected == Approx(2 / (1 - nu)).epsilon(1e-4));
}

TEST_CASE(
    "midedge_bending: sheets rolled up have the plate's energy, to second order where it is not exact") {
  const double radius = 0.4;
  for (const int axis : {0, 1}) {
    std::vector<std::vector<double>> errors(4);
    for (const int n : {11, 21, 41}) {
      const auto meshes = triangulations(n);
      for (std::size_t m = 0; m < meshes.size(); ++m) {
        const Positions x = rolled(meshes[m].mesh.vertices, radius, axis);
        const double mean = mean_of(inner_densities(Level::of(0, meshes[m].mesh), x, default_tolerance));
        errors[m].push_back(std::abs(mean / (k / (radius * radius)) - 1));
      }
    }
    for (std::size_t m = 0; m < errors.size(); ++m) {
      INFO(triangulations(5)[m].name << ": " << errors[m][0] << ", " << errors[m][1] << ", " << errors[m][2]);
      CHECK(errors[m][2] < 0.003);
      // With edges along the axis all angles are alike.
      if (m < 3 && errors[m][2] > 1e-12) CHECK(errors[m][1] / errors[m][2] == Approx(4).epsilon(0.2));
    }
  }
}

TEST_CASE("midedge_bending: lattices have narrow stencils") {
  const auto width = [](const TriangleMesh& mesh) { return bind(Level::of(0, mesh))->stencils().cols(); };
  CHECK(width(grid({1, 0.7}, 9, 9, Diagonals::one_way)) == 6);
  CHECK(width(random_triangulation({1, 1}, 100, 3)) == 12);
}

TEST_CASE("midedge_bending: derivatives where neighbours across different edges are the same vertex") {
  const TriangleMesh mesh = tetrahedron();  // a triangle's neighbours have the same vertex across all edges
  const auto bound = bind(Level::of(0, mesh));
  CHECK(bound->stencils().maxCoeff() == 3);
  const Positions x = shaken(mesh.vertices, 0.1, 3);
  const Positions g = gradient_of(*bound, x);
  REQUIRE(g.norm() > 0);
  CHECK((gradient_by_differences(*bound, x, 1e-4) - flat(g)).norm() <= 1e-7 * g.norm());
  const Eigen::MatrixXd h = dense(hessian_of(*bound, x, Projection::none));
  CHECK((hessian_by_differences(*bound, x, 1e-4) - h).norm() <= 1e-7 * h.norm());
}
