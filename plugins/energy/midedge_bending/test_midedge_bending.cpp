#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/elements/stretch.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "plugins/energy/midedge_bending/shape_operators.h"
#include "tests/conformance/energy_states.h"
#include "tests/support/decompositions.h"
#include "tests/support/kernel_check.h"
#include "tests/support/meshes.h"
#include "tests/support/strip.h"
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

/// With the rigidities of a cloth by direction.
const Material woven = [] {
  Material m = material;
  m.warp_bending = 3, m.weft_bending = 0.5, m.bias_bending = 0.8;
  return m;
}();

std::unique_ptr<BoundEnergy> bind(const TriangleMesh& mesh, const Material& of = material) {
  return MidedgeBending().bind(Level::of(0, mesh), of);
}

/// Runs the body on every triangulation of 0.6 × 0.5 m with about n × n vertices.
template <class Body>
void for_each_triangulation(int n, const Body& body) {
  for (const std::string& name : all_triangulations) {
    INFO(name);
    body(triangulated(name, {0.6, 0.5}, Eigen::Vector2i(n - 1, n - 1)));
  }
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
Eigen::VectorXd inner_densities(const Level& level, const Positions& x, double tolerance,
                                const Material& of = material) {
  const ShapeOperators operators = ShapeOperators::of(level, of, tolerance);
  std::vector<double> densities;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const auto& border = level.topology.on_border;
    if (border[v[0]] || border[v[1]] || border[v[2]]) continue;
    densities.push_back(bend_of(operators, level, x, t).squaredNorm() / RestTriangle::of(level, t).area);
  }
  REQUIRE(densities.size() > 10);
  return Eigen::Map<Eigen::VectorXd>(densities.data(), static_cast<Eigen::Index>(densities.size()));
}

/// Of a plate with the curvatures of shape.
double plate_density(const Eigen::Matrix2d& shape) {
  return k * ((1 - nu) * (shape * shape).trace() + nu * shape.trace() * shape.trace());
}

/// Largest relative deviation of `values` from `expected`.
double largest_miss(const Eigen::VectorXd& values, double expected) {
  return (values.array() / expected - 1).abs().maxCoeff();
}

/// Cylinders, a sphere and saddles.
std::vector<Eigen::Matrix2d> shapes() {
  return {Eigen::Matrix2d{{1, 0}, {0, 0}},       Eigen::Matrix2d{{.5, .5}, {.5, .5}},
          Eigen::Matrix2d{{.5, -.5}, {-.5, .5}}, Eigen::Matrix2d{{1, 0}, {0, 1}},
          Eigen::Matrix2d{{1, 0}, {0, -1}},      Eigen::Matrix2d{{0, 1}, {1, 0}}};
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

TEST_CASE("midedge_bending: inner triangles of every triangulation have the plate's energy on quadratics") {
  for_each_triangulation(12, [](const TriangleMesh& mesh) {
    const Level level = Level::of(0, mesh);
    for (const Eigen::Matrix2d& shape : shapes()) {
      const Positions x = bent(mesh, shape);
      INFO("shape\n" << shape);
      const double expected = small_curvature * small_curvature * plate_density(shape);
      CHECK(largest_miss(inner_densities(level, x, 0), expected) < 1e-6);
      CHECK(inner_densities(level, x, default_tolerance).mean() == Approx(expected).epsilon(0.005));
    }
  });
  // The average of the triangles' normals alone is not the plate's.
  const Level level = Level::of(0, grid({0.6, 0.6}, 12, 12, Diagonals::criss_cross));
  const Eigen::Matrix2d saddle = shapes()[5];
  const double expected = small_curvature * small_curvature * plate_density(saddle) * 2 / (1 - nu);
  CHECK(largest_miss(inner_densities(level, bent(level.rest, saddle), 1), expected) < 1e-4);
}

TEST_CASE("midedge_bending: a free plate has no modes without energy but the rigid ones") {
  for_each_triangulation(7, [](const TriangleMesh& mesh) {
    const Eigen::MatrixXd all = dense(hessian_of(*bind(mesh), mesh.vertices, Projection::none));
    const Eigen::MatrixXd hessian = all(Eigen::seq(2, Eigen::last, 3), Eigen::seq(2, Eigen::last, 3));
    const Eigen::VectorXd values = eigenvalues_of(hessian);
    CHECK(values.head(3).cwiseAbs().maxCoeff() < 1e-10 * values.maxCoeff());
    // The softest mode of a plate is nearly its twist.
    const Eigen::VectorXd twist =
        (mesh.vertices.col(0).array() - 0.3) * (mesh.vertices.col(1).array() - 0.25);
    CHECK(values[3] > 0.9 * twist.dot(hessian * twist) / twist.squaredNorm());
  });
}

TEST_CASE("midedge_bending: rigidities by direction are the plate's, equal ones the isotropic plate") {
  const OrthotropicStiffness c = plate_stiffness(woven);
  CHECK(c.strip(0) == Approx(3));
  CHECK(c.strip(M_PI / 2) == Approx(0.5));
  CHECK(c.strip(M_PI / 4) == Approx(0.8));
  Material isotropic = material;
  isotropic.warp_bending = isotropic.weft_bending = isotropic.bias_bending = 2 * k * (1 - nu * nu);
  const Eigen::Matrix2d to_warp = Eigen::Rotation2Dd(-25 * M_PI / 180).toRotationMatrix();
  for_each_triangulation(12, [&](TriangleMesh mesh) {
    mesh.warp = warp_at(mesh, 25);
    const Level level = Level::of(0, mesh);
    for (const Eigen::Matrix2d& shape : shapes()) {
      const Eigen::Matrix2d own = to_warp * shape * to_warp.transpose();
      const double expected = small_curvature * small_curvature *
                              (0.5 * (c.c11 * own(0, 0) * own(0, 0) + c.c22 * own(1, 1) * own(1, 1)) +
                               c.c12 * own(0, 0) * own(1, 1) + 2 * c.c66 * own(0, 1) * own(0, 1));
      INFO("shape\n" << shape);
      CHECK(largest_miss(inner_densities(level, bent(mesh, shape), 0, woven), expected) < 1e-6);
    }
    const Positions x = wavy(mesh, 0.1);
    CHECK(bind(mesh, isotropic)->value(x) == Approx(bind(mesh)->value(x)).epsilon(1e-12));
  });
}

TEST_CASE("midedge_bending: friction adds its moment to a bent strip's, and derivatives follow") {
  Material rubbing = material;
  const double rigidity = 2 * k * (1 - nu * nu), moment = 0.4, sliding = MidedgeBending().sliding_curvature;
  rubbing.bending_hysteresis = 2 * moment;
  for_each_triangulation(5, [&](const TriangleMesh& mesh) {
    const Level level = Level::of(0, mesh);
    const ShapeOperators operators = ShapeOperators::of(level, rubbing, default_tolerance);
    const auto own = bind(mesh, rubbing);
    CHECK(own->value(mesh.vertices) == 0);
    for (const double height : {1e-4, 0.01, 0.1}) {  // sticking to sliding
      const Positions x = wavy(mesh, height);
      double expected = 0;
      for (int t = 0; t < level.triangle_count(); ++t) {
        const double elastic = bend_of(operators, level, x, t).squaredNorm(),
                     area = RestTriangle::of(level, t).area,
                     curvature = std::sqrt(2 * elastic / (rigidity * area));  // of the strip
        expected += elastic + area * moment * (std::hypot(curvature, sliding) - sliding);
      }
      CHECK(own->value(x) == Approx(expected));
      CHECK(own->value(x) > bind(mesh)->value(x));
      energy_states::check_derivatives(*own, x, 1e-5, 1e-6, 1e-5);
      const Eigen::VectorXd clamped = eigenvalues_of(dense(hessian_of(*own, x, Projection::clamp)));
      CHECK(clamped.minCoeff() > -1e-10 * clamped.maxCoeff());
    }
  });
}

TEST_CASE(
    "midedge_bending: sharp folds have their energy on the mesh that is split at its edges' midpoints") {
  for_each_triangulation(12, [](const TriangleMesh& mesh) {
    const Level level = Level::of(0, mesh);
    // A free border's triangles give way, so none of them is bent.
    std::vector<char> near_border = level.topology.on_border;
    for (const auto& v : mesh.triangles.rowwise())
      if (level.topology.on_border[v[0]] || level.topology.on_border[v[1]] || level.topology.on_border[v[2]])
        for (const int corner : v) near_border[corner] = 1;
    for (const Material& of : {material, woven}) {
      Positions x = shaken(mesh.vertices, 0.02, 5);
      for (int v = 0; v < x.rows(); ++v)
        if (near_border[v]) x.row(v) = mesh.vertices.row(v);
      Level split = level;
      Positions split_x = x;
      for (const double sharpness : {2, 4}) {
        const ProlongationMatrix midpoints = midpoint_weights(split);
        split_x = (midpoints * split_x).eval();
        split = Level::of(1, refined_rest(split, midpoints));
        const auto energies = [&](double tolerance) {
          MidedgeBending energy;
          energy.correction_tolerance = tolerance;
          const Eigen::VectorXd sharp = Eigen::VectorXd::Constant(level.hinges.rows(), sharpness);
          return std::pair(energy.bind_sharp(level, of, sharp)->value(x),
                           energy.bind(split, of)->value(split_x));
        };
        const auto [plain, plain_split] = energies(1);
        CHECK(plain == Approx(plain_split).epsilon(1e-10));
        const auto [corrected, corrected_split] = energies(default_tolerance);
        CHECK(corrected == Approx(corrected_split).epsilon(0.05));
      }
    }
  });
}

TEST_CASE("midedge_bending: sharp folds' derivatives are those of their energy") {
  Material rubbing = material;
  rubbing.bending_hysteresis = 0.8;
  for_each_triangulation(5, [&](const TriangleMesh& mesh) {
    const Level level = Level::of(0, mesh);
    const Eigen::VectorXd sharpness = Eigen::VectorXd::LinSpaced(level.hinges.rows(), 1, 8);
    const auto own = MidedgeBending().bind_sharp(level, rubbing, sharpness);
    const Positions x = wavy(mesh, 0.1);
    energy_states::check_derivatives(*own, x, 1e-5, 1e-6, 1e-5);
    const Eigen::VectorXd clamped = eigenvalues_of(dense(hessian_of(*own, x, Projection::clamp)));
    CHECK(clamped.minCoeff() > -1e-10 * clamped.maxCoeff());
  });
}

TEST_CASE("midedge_bending: stencils are narrow on lattices, and right where neighbours are one vertex") {
  CHECK(bind(grid({1, 0.7}, 9, 9, Diagonals::one_way))->stencils().cols() == 6);
  CHECK(bind(random_triangulation({1, 1}, 100, 3))->stencils().cols() == 12);
  const TriangleMesh mesh = tetrahedron();  // a triangle's neighbours have the same vertex across all edges
  const auto bound = bind(mesh);
  CHECK(bound->stencils().maxCoeff() == 3);
  const Positions x = shaken(mesh.vertices, 0.1, 3);
  energy_states::check_derivatives(*bound, x, 1e-4);
}
