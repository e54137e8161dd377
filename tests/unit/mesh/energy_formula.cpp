#include "core/numerics/formulas/energy_formula.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/formulas/metric_formula.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/evaluate.h"
#include "tests/support/kernel_check.h"
#include "tests/support/unregistered.h"

struct Woven {
  double warp = 2e3, weft = 5e2;
  static void declare(drape::Declaration<Woven>& d) {
    d.add("warp", &Woven::warp);
    d.add("weft", &Woven::weft);
  }
};

DRAPE_MEMBRANE(woven, "Stiff along warp.", Woven) {
  return 0.5 * warp * g11 * g11 + 0.5 * weft * g22 * g22 + 60 * g12 * g12;
}
DRAPE_MEMBRANE(every_function, "Isotropic.") {
  const S trace = g11 + g22, l = log(J), q = square(trace) / (1.0 + exp(trace));
  const S odd = sin(trace) * tanh(l) + atan2(trace, 2.0 + l) * asin(0.1 * trace) - cos(l) * expm1(q);
  const S kinks = max(trace, 0.3 * l) + select(l > 0.01, pow(l, 3), abs(l) * l) + min(q, 1 / (2 + trace));
  return thickness * (mu * (trace - l) + lambda / 2 * l * l + mu * (odd + kinks) * pow(J, 1.5) * sqrt(1 + q));
}
DRAPE_MEMBRANE(seam, "Stiffer on one side.") { return select(u > 0.5, 2.0, 1.0) * g11 * g11; }
DRAPE_MEMBRANE(sized, "Depends on the mesh.") { return sqrt(area) * g11 * g11; }
DRAPE_MEMBRANE(at_rest, "With functions of numbers at rest.") {
  return mu * (1 + max(u - 0.5, 0.0)) * pow(area, 2) * (square(J) - 1 - 2 * log(J));
}
DRAPE_FOLD(crease, "A plastic rest angle.") { return 3 * k * length * length / area * square(bend - 0.3); }
DRAPE_FOLD(fold, "As hinge.") { return 3 * k * length * length / area * square(bend); }
DRAPE_FOLD(late, "Begins at 3.1 rad.") {
  return 3 * k * length * length / area * square(max(abs(bend) - 3.1, S(0.0)));
}
DRAPE_VERTEX(wind, "Constant forces.") { return -2.0 * area * x - 0.5 * mass * z + 1e-3 * area; }
DRAPE_VERTEX(patch_wind, "On half of the cloth.") { return select(u > 0.5, -2.0 * area, 0.0 * area) * x; }
DRAPE_VERTEX(gust, "Only above the ground.") { return select(z > 0.01, -2.0 * area * x, 0.0); }
struct Spring {
  static constexpr auto role = drape::EnergyRole::position;
  static void declare(drape::Declaration<Spring>&) {}
};
DRAPE_VERTEX(spring, "To the ground.", Spring) { return 200 * mass * z * z; }

struct Loaded {
  static constexpr auto role = drape::EnergyRole::external;
  double pressure = 3;
  static void declare(drape::Declaration<Loaded>& d) { d.add("pressure", &Loaded::pressure); }
};
struct Rubber {
  double alpha = 1.8;
  static void declare(drape::Declaration<Rubber>& d) { d.add("alpha", &Rubber::alpha); }
};
DRAPE_MEMBRANE(ogden, "By principal stretches.", Rubber) {
  return thickness * mu * (pow(s1, alpha) + pow(s2, alpha) + pow(J, -alpha) - 3);
}
DRAPE_MEMBRANE(stretches_of_stvk, "As strains_of_stvk.") {
  const S e1 = 0.5 * (s1 * s1 - 1), e2 = 0.5 * (s2 * s2 - 1);
  return thickness * (mu * (e1 * e1 + e2 * e2) + lambda / 2 * square(e1 + e2));
}
DRAPE_MEMBRANE(strains_of_stvk, "As stretches_of_stvk.") {
  return thickness * (mu * (g11 * g11 + g22 * g22 + 2 * g12 * g12) + lambda / 2 * square(g11 + g22));
}
DRAPE_MEMBRANE(mixed, "By strains and stretches.") { return g11 * s1; }
DRAPE_ELEMENT(springs, edges, "Along edges.", Rubber) {
  const T length = rest[0].norm();
  return alpha * square(d[0].norm() / length - 1) * length;
}
namespace drape::elements {
/// Each vertex and the one after the next.
struct every_second {
  static constexpr int vertices = 2;
  static constexpr EnergyRole role = EnergyRole::position;
  static Stencils of(const Level& level) {
    Stencils pairs(level.vertex_count() - 2, 2);
    for (int i = 0; i < pairs.rows(); ++i) pairs.row(i) << i, i + 2;
    return pairs;
  }
  static ElementOrder order(const Level& level) { return ElementOrder::of(of(level), level.rest.vertices); }
};
/// Two vertices by their numbers.
struct tied {
  static constexpr int vertices = 2;
  static constexpr EnergyRole role = EnergyRole::bending;
  static Stencils of(const Level&) { return Stencils{{0, 60}}; }
  static ElementOrder order(const Level& level) { return ElementOrder::of(of(level), level.rest.vertices); }
};
}  // namespace drape::elements
DRAPE_ELEMENT(tie, tied, "Pulled together.") { return 5 * d[0].squaredNorm(); }
DRAPE_ELEMENT(seams, every_second, "Pulled together.") { return 5 * d[0].squaredNorm(); }
DRAPE_ELEMENT(stvk_by_edges, triangles, "As strains_of_stvk.") {
  const T a = rest[0].squaredNorm(), b = rest[0].dot(rest[1]), c = rest[1].squaredNorm(), det = a * c - b * b;
  const S p = 0.5 * (d[0].squaredNorm() - a), q = 0.5 * (d[0].dot(d[1]) - b),
          r = 0.5 * (d[1].squaredNorm() - c);
  const S trace = (c * p - 2 * b * q + a * r) / det, minor = (p * r - q * q) / det;
  return 0.5 * sqrt(det) * thickness * (mu * (trace * trace - 2 * minor) + lambda / 2 * trace * trace);
}
DRAPE_ELEMENT(quadratic, hinges, "As quadratic_bending.") {
  const T length = rest[0].norm(), u = rest[0].cross(rest[1]).norm(), v = rest[0].cross(rest[2]).norm();
  const T at_u = length / u, at_v = length / v, squared = length * length;
  const T at_e = (rest[0].dot(rest[1]) * at_u + rest[0].dot(rest[2]) * at_v) / squared;
  const Vector<S> curvature = d[0] * at_e - d[1] * at_u - d[2] * at_v;
  return 6 * k * squared / (u + v) * curvature.squaredNorm();
}
DRAPE_MEMBRANE(tension, "A load.", Loaded) { return pressure * J; }
DRAPE_ELEMENT(volume, triangles, "A load.", Loaded) { return pressure * d[0].cross(d[1]).norm(); }

struct Ground {
  double ground = 0;
  static void declare(drape::Declaration<Ground>& d) { d.add("ground", &Ground::ground); }
};
DRAPE_METRIC(above, "Height above the ground.", "m", neither, Ground) { return x.col(2).minCoeff() - ground; }

using namespace drape;

namespace {

Level sheet() { return Level::of(0, grid({1, 1}, 9, 8, Diagonals::criss_cross)); }

Positions wrinkled(const Level& level, double size = 0.02) { return shaken(level.rest.vertices, size, 3); }

Eigen::VectorXd flat_values(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Derivatives agree with differences of the value, and the gradient's value is the value.
void check_derivatives(const Energy& energy) {
  const Level level = sheet();
  const auto bound = energy.bind(level, Material());
  const Positions x = wrinkled(level), direction = wrinkled(level, 0.3) - level.rest.vertices;
  Positions g = Positions::Zero(x.rows(), 3);
  const double value = bound->value(x), h = 1e-5;
  REQUIRE(value != 0);
  CHECK(bound->add_gradient(x, g) == value);
  const double slope = (bound->value(x + h * direction) - bound->value(x - h * direction)) / (2 * h);
  CHECK(g.cwiseProduct(direction).sum() == Approx(slope).epsilon(1e-6));
  if (bound->stencils().rows() == 0) return;
  const Positions change =
      (gradient_of(*bound, x + h * direction) - gradient_of(*bound, x - h * direction)) / (2 * h);
  const auto hessian = hessian_of(*bound, x, Projection::none);
  Positions product = Positions::Zero(x.rows(), 3);
  hessian.multiply(direction, product);
  CHECK((product - change).norm() <= 1e-6 * change.norm());
}

}  // namespace

TEST_CASE("energy_formula: derivatives of membranes, folds and loads follow from the formula") {
  check_derivatives(MembraneFormula<formulas::woven>({}));
  check_derivatives(MembraneFormula<formulas::every_function>({}));
  check_derivatives(MembraneFormula<formulas::seam>({}));
  check_derivatives(MembraneFormula<formulas::ogden>({}));
  check_derivatives(ElementFormula<formulas::springs, elements::edges>({}));
  check_derivatives(ElementFormula<formulas::seams, elements::every_second>({}));
  check_derivatives(ElementFormula<formulas::tie, elements::tied>({}));
  check_derivatives(MembraneFormula<formulas::at_rest>({}));
  check_derivatives(ElementFormula<formulas::stvk_by_edges, elements::triangles>({}));
  check_derivatives(ElementFormula<formulas::quadratic, elements::hinges>({}));
  check_derivatives(ElementFormula<formulas::volume, elements::triangles>({}));
  check_derivatives(FoldFormula<formulas::crease>({}));
  check_derivatives(VertexFormula<formulas::wind>({}));
  check_derivatives(VertexFormula<formulas::gust>({}));
  check_derivatives(VertexFormula<formulas::spring>({}));
}

TEST_CASE("energy_formula: role and midpoint factor follow from the kind and the symbols") {
  CHECK(MembraneFormula<formulas::woven>({}).role() == EnergyRole::membrane);
  CHECK(MembraneFormula<formulas::woven>({}).midpoint_factor() == 1);
  CHECK_FALSE(MembraneFormula<formulas::seam>({}).midpoint_factor());
  CHECK_FALSE(MembraneFormula<formulas::sized>({}).midpoint_factor());
  CHECK(MembraneFormula<formulas::ogden>({}).midpoint_factor() == 1);
  CHECK(ElementFormula<formulas::springs, elements::edges>({}).role() == EnergyRole::membrane);
  CHECK_FALSE(ElementFormula<formulas::springs, elements::edges>({}).midpoint_factor());
  CHECK(ElementFormula<formulas::stvk_by_edges, elements::triangles>({}).midpoint_factor() == 1);
  CHECK(ElementFormula<formulas::seams, elements::every_second>({}).role() == EnergyRole::position);
  CHECK(MembraneFormula<formulas::tension>({}).role() == EnergyRole::external);
  CHECK(ElementFormula<formulas::volume, elements::triangles>({}).role() == EnergyRole::external);
  CHECK(ElementFormula<formulas::quadratic, elements::hinges>({}).role() == EnergyRole::bending);
  CHECK(ElementFormula<formulas::quadratic, elements::hinges>({}).midpoint_factor() == 2);
  CHECK(ElementFormula<formulas::quadratic, elements::hinges>({}).plate_stiffness(Material()) ==
        Approx(FoldFormula<formulas::fold>({}).plate_stiffness(Material())).epsilon(1e-3));
  CHECK(FoldFormula<formulas::fold>({}).role() == EnergyRole::bending);
  CHECK(FoldFormula<formulas::fold>({}).midpoint_factor() == 2);
  CHECK_FALSE(FoldFormula<formulas::crease>({}).midpoint_factor());
  CHECK_FALSE(FoldFormula<formulas::late>({}).midpoint_factor());
  CHECK(VertexFormula<formulas::wind>({}).role() == EnergyRole::external);
  CHECK(VertexFormula<formulas::wind>({}).midpoint_factor() == 1);
  CHECK(VertexFormula<formulas::spring>({}).role() == EnergyRole::position);
  CHECK_FALSE(VertexFormula<formulas::patch_wind>({}).midpoint_factor());
  CHECK_FALSE(VertexFormula<formulas::gust>({}).midpoint_factor());
  CHECK_FALSE(VertexFormula<formulas::spring>({}).midpoint_factor());
}

TEST_CASE("energy_formula: a load that is linear in positions has no Hessian, another has") {
  const Level level = sheet();
  const auto rows = [&](const Energy& energy) { return energy.bind(level, Material())->stencils().rows(); };
  CHECK(rows(VertexFormula<formulas::wind>({})) == 0);
  CHECK(rows(VertexFormula<formulas::patch_wind>({})) == 0);
  CHECK(rows(VertexFormula<formulas::gust>({})) == level.vertex_count());
  CHECK(rows(VertexFormula<formulas::spring>({})) == level.vertex_count());
  const Positions g =
      gradient_of(*VertexFormula<formulas::patch_wind>({}).bind(level, Material()), wrinkled(level));
  for (int i = 0; i < level.vertex_count(); ++i)
    CHECK(g(i, 0) == (level.rest.vertices(i, 0) > 0.5 ? -2 * level.vertex_area[i] : 0));
}

TEST_CASE("energy_formula: grain turns warp, and membranes buckle below the mesh") {
  const Level level = sheet();
  Positions x = level.rest.vertices;
  x.col(1) *= 1.1;
  const auto energy_with = [&](double grain) {
    TriangleMesh mesh = level.rest;
    mesh.warp = warp_at(mesh, grain);
    return MembraneFormula<formulas::woven>({}).bind(Level::of(0, mesh), Material())->value(x);
  };
  const double g = 0.5 * (1.1 * 1.1 - 1);
  CHECK(energy_with(0) == Approx(0.5 * 5e2 * g * g));
  CHECK(energy_with(90) == Approx(0.5 * 2e3 * g * g));

  x = 0.9 * level.rest.vertices;
  const auto check_buckling = [&](const Energy& energy) {
    CHECK(energy.bind_buckling(level, Material(), 0)->value(x) <
          0.5 * energy.bind(level, Material())->value(x));
  };
  check_buckling(MembraneFormula<formulas::woven>({}));
  check_buckling(MembraneFormula<formulas::every_function>({}));
  check_buckling(MembraneFormula<formulas::ogden>({}));
}

TEST_CASE("energy_formula: a law by strains, by stretches and by edge vectors is one energy") {
  const Level level = sheet();
  const Material material;
  const auto strains = MembraneFormula<formulas::strains_of_stvk>({}).bind(level, material),
             stretches = MembraneFormula<formulas::stretches_of_stvk>({}).bind(level, material),
             edges = ElementFormula<formulas::stvk_by_edges, elements::triangles>({}).bind(level, material);
  for (const double size : {0.002, 0.02}) {
    const Positions x = wrinkled(level, size), g = gradient_of(*strains, x);
    const auto h = hessian_of(*strains, x, Projection::clamp).values;
    for (const BoundEnergy* other : {stretches.get(), edges.get()}) {
      CHECK(other->stencils() == strains->stencils());
      CHECK(other->value(x) == Approx(strains->value(x)).epsilon(1e-11));
      CHECK((gradient_of(*other, x) - g).norm() <= 1e-11 * g.norm());
      const auto own = hessian_of(*other, x, Projection::clamp).values;
      CHECK((flat_values(own) - flat_values(h)).norm() <= 1e-9 * flat_values(h).norm());
    }
  }
  CHECK_THROWS_WITH(MembraneFormula<formulas::mixed>({}),
                    Catch::Contains("uses Green strains (g11, g22, g12) and principal stretches (s1, s2)"));
}

TEST_CASE("energy_formula: log(J) keeps the digits of small strains") {
  using J = Jet<1, double>;
  for (const double strain : {1e-4, 1e-7, 1e-10}) {
    const double g = strain + strain * strain / 2, det = (1 + 2 * g) * (1 + 2 * g);
    CHECK(log(area_ratio<1>(g, g, 0.0, det)).value == Approx(2 * std::log1p(strain)).epsilon(1e-12));
  }
  const double det = 2 * 1.4 - 0.04;
  CHECK(log(area_ratio<1>(0.5, 0.2, 0.1, det)).value == Approx(std::log(det) / 2));
  CHECK(J(area_ratio<1>(0.5, 0.2, 0.1, det)).value == Approx(std::sqrt(det)));
}

TEST_CASE("energy_formula: elements of vertices that a level does not have are refused") {
  const ElementFormula<formulas::tie, elements::tied> tie({});
  CHECK_FALSE(tie.midpoint_factor());
  CHECK(tie.plate_stiffness(Material()) == 0);
  CHECK_THROWS_WITH(tie.bind(Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way)), Material()),
                    Catch::Contains("has a vertex that level 0"));
}

TEST_CASE("metric_formula: a metric has the parameters of its struct") {
  Registry registry;
  registry.add<Metric, formulas::above>("above", "A.");
  CHECK(registry.find("metric", "above")->schema.parameters.size() == 1);
}
