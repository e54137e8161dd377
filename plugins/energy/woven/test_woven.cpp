#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/patterns/generate.h"
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

Level sheet(double grain = 0) {
  TriangleMesh mesh = random_triangulation({0.6, 0.5}, 120, 8);
  mesh.warp = warp_at(mesh, grain);
  return Level::of(0, mesh);
}

Positions wrinkled(const Level& level, double size) {
  Positions x = level.rest.vertices;
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += size * std::sin(static_cast<double>(41 * i + 2));
  return x;
}

}  // namespace

TEST_CASE("woven: strips along warp and weft have the stiffness that was measured") {
  const OrthotropicStiffness c = membrane_stiffness(fabric);
  CHECK(c.strip(0) == Approx(2000));
  CHECK(c.strip(M_PI / 2) == Approx(700));
}

TEST_CASE("woven: the isotropic cloth is stvk, and at rest neo_hookean") {
  Material material;
  material.poisson_ratio = 0.3;
  const Level level = sheet(17);
  const auto own = make_plugin_from<Energy>("woven")->bind(level, material),
             stvk = make_plugin_from<Energy>("stvk")->bind(level, material),
             neo_hookean = make_plugin_from<Energy>("neo_hookean")->bind(level, material);
  const Positions x = wrinkled(level, 0.004);
  CHECK(std::abs(own->value(x) / stvk->value(x) - 1) < 1e-12);
  CHECK((gradient_of(*own, x) - gradient_of(*stvk, x)).norm() < 1e-12 * gradient_of(*stvk, x).norm());
  const auto h = dense(hessian_of(*own, level.rest.vertices, Projection::none)),
             other = dense(hessian_of(*neo_hookean, level.rest.vertices, Projection::none));
  CHECK((h - other).norm() < 1e-12 * other.norm());
}

TEST_CASE("woven: a quarter turn of grain and cloth changes no energy") {
  const Level level = sheet(25);
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  TriangleMesh turned = level.rest;
  turned.vertices = level.rest.vertices * turn.transpose();
  turned.warp = level.rest.warp * turn.transpose();
  Material swapped = fabric;
  std::swap(swapped.warp_stiffness, swapped.weft_stiffness);
  TriangleMesh other = level.rest;
  other.warp = warp_at(other, 115);
  const auto energy = make_plugin_from<Energy>("woven");
  const Positions x = wrinkled(level, 0.004);
  for (const double s : {-1., 1e-3}) {  // plain, and buckling
    const auto value = [&](const TriangleMesh& mesh, const Material& m, const Positions& y) {
      const Level own = Level::of(0, mesh);
      return (s < 0 ? energy->bind(own, m) : energy->bind_buckling(own, m, s))->value(y);
    };
    const double own = value(level.rest, fabric, x);
    CHECK(std::abs(value(turned, fabric, x * turn.transpose()) / own - 1) < 1e-12);
    CHECK(std::abs(value(other, swapped, x) / own - 1) < 1e-12);
    CHECK(std::abs(value(other, fabric, x) / own - 1) > 1e-3);
  }
}

TEST_CASE("woven: the isotropic cloth buckles below the mesh as stvk does, and woven cloth softly") {
  Material material;
  const Level level = sheet(17);
  const auto energy = make_plugin_from<Energy>("woven");
  const auto own = energy->bind_buckling(level, material, 1e-5),
             stvk = make_plugin_from<Energy>("stvk")->bind_buckling(level, material, 1e-5);
  const Positions x = wrinkled(level, 5e-4);
  CHECK(own->value(x) == Approx(stvk->value(x)).epsilon(1e-9));
  CHECK((gradient_of(*own, x) - gradient_of(*stvk, x)).norm() < 1e-7 * gradient_of(*stvk, x).norm());
  const Positions pressed = 0.95 * level.rest.vertices;
  CHECK(energy->bind_buckling(level, fabric, 1e-5)->value(pressed) <
        0.05 * energy->bind(level, fabric)->value(pressed));
}

TEST_CASE("woven: a strip whose sides are free has the tension curve that was measured") {
  const std::vector<std::pair<double, double>> points = {{0.02, 3}, {0.05, 40}, {0.08, 200}};
  const std::string list = "[0.02, 3, 0.05, 40, 0.08, 200]";
  for (const std::string direction : {"warp", "weft"}) {
    INFO(direction);
    const auto energy = make_plugin_from<Energy>("{type: woven, " + direction + "_tension: " + list + "}");
    TriangleMesh mesh = grid({0.1, 0.1}, 2, 2, Diagonals::one_way);
    mesh.warp = warp_at(mesh, direction == "warp" ? 0. : 90.);
    const auto bound = energy->bind(Level::of(0, mesh), fabric);
    // Along an axis, on the side that is farther along it.
    const auto force = [&](int axis, double strain, double across) {
      const Eigen::Vector3d stretch(1 + strain, across, 1);
      const Positions g = gradient_of(*bound, mesh.vertices * stretch.asDiagonal());
      double sum = 0;
      for (int i = 0; i < 4; ++i) sum += mesh.vertices(i, axis) > 0 ? g(i, axis) : 0;
      return sum;
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
  const Level level = sheet(25);
  const auto curved = make_plugin_from<Energy>(
                 "{type: woven, warp_tension: [0.01, 5, 0.03, 50], weft_tension: [0.05, 20, 0.1, 30]}"),
             straight = make_plugin_from<Energy>(
                 "{type: woven, warp_tension: [1e-6, 2000e-6], weft_tension: [1e-6, 700e-6]}");
  const Positions x = wrinkled(level, 0.004);
  const auto own = curved->bind(level, fabric),
             plain = make_plugin_from<Energy>("woven")->bind(level, fabric);
  CHECK(straight->bind(level, fabric)->value(x) == Approx(plain->value(x)).epsilon(1e-5));
  CHECK(own->value(x) > 0);
  const Positions g = gradient_of(*own, x);
  CHECK((gradient_by_differences(*own, x, 1e-6) - flat(g)).norm() <= 1e-6 * g.norm());
  const Eigen::MatrixXd h = dense(hessian_of(*own, x, Projection::none));
  CHECK((hessian_by_differences(*own, x, 1e-7) - h).norm() <= 1e-5 * h.norm());
  CHECK(curved->bind_buckling(level, fabric, 1e-5)->value(x) <= own->value(x) * (1 + 1e-12));
}

TEST_CASE("woven: a tension curve out of order is refused at its point") {
  const auto refused = [](const std::string& list, const std::string& message) {
    CHECK_THROWS_WITH(make_plugin_from<Energy>("{type: woven, warp_tension: " + list + "}"),
                      Catch::Contains(message));
  };
  refused("[0.01, 5, 0.03]", "\"warp_tension\" has an odd number of values");
  refused("[0.01, 5, 0.01, 7]", "\"warp_tension\": point 2: strain does not rise from the point before");
  refused("[0.01, 5, 0.03, 4]", "point 2: force over stretch does not rise from the point before");
  refused("[0, 5]", "point 1: strain does not rise");
}
