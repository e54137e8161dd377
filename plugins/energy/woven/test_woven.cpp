#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <optional>

#include "core/numerics/patterns/generate.h"
#include "tests/conformance/energy_states.h"
#include "tests/support/evaluate.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

const Material fabric = [] {
  Material m;
  m.thickness = 3e-4;
  m.warp_stiffness = 2000, m.weft_stiffness = 700, m.shear_stiffness = 50, m.poisson_ratio = 0.2;
  return m;
}();

TriangleMesh sheet(double grain) {
  TriangleMesh mesh = random_triangulation({0.6, 0.5}, 120, 8);
  mesh.warp = warp_at(mesh, grain);
  return mesh;
}

Positions wrinkled(const TriangleMesh& mesh, double size) {
  Positions x = mesh.vertices;
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += size * std::sin(static_cast<double>(41 * i + 2));
  return x;
}

/// The energy on a level, or its membrane that buckles below the mesh if a bound is given.
std::unique_ptr<BoundEnergy> bound(const std::string& energy, const TriangleMesh& mesh, const Material& m,
                                   std::optional<double> buckling = {}) {
  const auto plugin = make_plugin_from<Energy>(energy);
  const Level level = Level::of(0, mesh);
  return buckling ? plugin->bind_buckling(level, m, *buckling) : plugin->bind(level, m);
}

}  // namespace

TEST_CASE("woven: the isotropic cloth is stvk, also where it buckles, and at rest neo_hookean") {
  Material material;
  material.poisson_ratio = 0.3;
  const TriangleMesh mesh = sheet(17);
  const auto check = [&](std::optional<double> buckling, double size, double tolerance, double of_forces) {
    const auto own = bound("woven", mesh, material, buckling), stvk = bound("stvk", mesh, material, buckling);
    const Positions x = wrinkled(mesh, size), g = gradient_of(*stvk, x);
    CHECK(std::abs(own->value(x) / stvk->value(x) - 1) < tolerance);
    CHECK((gradient_of(*own, x) - g).norm() < of_forces * g.norm());
  };
  check({}, 0.004, 1e-12, 1e-12);
  check(1e-5, 5e-4, 1e-9, 1e-7);
  const auto stiffness = [&](const std::string& energy) {
    return dense(hessian_of(*bound(energy, mesh, material), mesh.vertices, Projection::none));
  };
  const Eigen::MatrixXd other = stiffness("neo_hookean");
  CHECK((stiffness("woven") - other).norm() < 1e-12 * other.norm());
}

TEST_CASE("woven: a quarter turn of grain and cloth changes no energy, and cloth buckles softly") {
  const TriangleMesh mesh = sheet(25);
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  TriangleMesh turned = mesh, other = mesh;
  turned.vertices = mesh.vertices * turn.transpose();
  turned.warp = mesh.warp * turn.transpose();
  other.warp = warp_at(other, 115);
  Material swapped = fabric;
  std::swap(swapped.warp_stiffness, swapped.weft_stiffness);
  const Positions x = wrinkled(mesh, 0.004);
  for (const auto buckling : {std::optional<double>(), std::optional(1e-3)}) {
    const double own = bound("woven", mesh, fabric, buckling)->value(x);
    CHECK(std::abs(bound("woven", turned, fabric, buckling)->value(x * turn.transpose()) / own - 1) < 1e-12);
    CHECK(std::abs(bound("woven", other, swapped, buckling)->value(x) / own - 1) < 1e-12);
    CHECK(std::abs(bound("woven", other, fabric, buckling)->value(x) / own - 1) > 1e-3);
  }
  const Positions pressed = 0.95 * mesh.vertices;
  CHECK(bound("woven", mesh, fabric, 1e-5)->value(pressed) <
        0.05 * bound("woven", mesh, fabric)->value(pressed));
}

TEST_CASE("woven: a strip whose sides are free has the tension curve that was measured") {
  const std::vector<std::pair<double, double>> points = {{0.02, 3}, {0.05, 40}, {0.08, 200}};
  for (const std::string direction : {"warp", "weft"}) {
    INFO(direction);
    TriangleMesh mesh = grid({0.1, 0.1}, 2, 2, Diagonals::one_way);
    mesh.warp = warp_at(mesh, direction == "warp" ? 0. : 90.);
    const auto energy =
        bound("{type: woven, " + direction + "_tension: [0.02, 3, 0.05, 40, 0.08, 200]}", mesh, fabric);
    // Along an axis, on the side that is farther along it.
    const auto force = [&](int axis, double strain, double across) {
      const Eigen::Vector3d stretch(1 + strain, across, 1);
      const Positions g = gradient_of(*energy, mesh.vertices * stretch.asDiagonal());
      return (mesh.vertices.col(axis).array() > 0).select(g.col(axis), 0).sum();
    };
    for (const auto& [strain, tension] : points) {
      double low = 0.5, high = 1;  // across, until no force acts there
      for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (force(1, strain, middle) > 0 ? high : low) = middle;
      }
      CHECK(low < 1);
      CHECK(force(0, strain, low) / 0.1 == Approx(tension).epsilon(1e-9));
    }
  }
}

TEST_CASE("woven: derivatives follow the tension curve, which may be straight") {
  const TriangleMesh mesh = sheet(25);
  const std::string curved =
      "{type: woven, warp_tension: [0.01, 5, 0.03, 50], weft_tension: [0.05, 20, 0.1, 30]}";
  const std::string straight = "{type: woven, warp_tension: [1e-6, 2000e-6], weft_tension: [1e-6, 700e-6]}";
  const Positions x = wrinkled(mesh, 0.004);
  CHECK(bound(straight, mesh, fabric)->value(x) ==
        Approx(bound("woven", mesh, fabric)->value(x)).epsilon(1e-5));
  const auto own = bound(curved, mesh, fabric);
  CHECK(own->value(x) > 0);
  energy_states::check_derivatives(*own, x, 1e-7, 1e-6, 1e-5);
  CHECK(bound(curved, mesh, fabric, 1e-5)->value(x) <= own->value(x) * (1 + 1e-12));
}
