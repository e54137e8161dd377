#include "core/numerics/formulas/energy_formula.h"

#include <catch2/catch.hpp>

#include "core/numerics/formulas/metric_formula.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/evaluate.h"
#include "tests/support/kernel_check.h"
#include "tests/support/unregistered.h"

DRAPE_PARAMETERS(Woven, (warp, 2e3, "N/m", 0, 1e9, ""), (weft, 5e2, "N/m", 0, 1e9, ""));

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
struct Positioned {
  static constexpr auto role = drape::EnergyRole::position;
  static void declare(drape::Declaration<Positioned>&) {}
};
DRAPE_VERTEX(spring, "To the ground.", Positioned) { return 200 * mass * z * z; }

DRAPE_MEMBRANE(stretches_of_stvk, "As strains_of_stvk.") {
  const S e1 = 0.5 * (s1 * s1 - 1), e2 = 0.5 * (s2 * s2 - 1);
  return thickness * (mu * (e1 * e1 + e2 * e2) + lambda / 2 * square(e1 + e2));
}
DRAPE_MEMBRANE(strains_of_stvk, "As stretches_of_stvk.") {
  return thickness * (mu * (g11 * g11 + g22 * g22 + 2 * g12 * g12) + lambda / 2 * square(g11 + g22));
}
DRAPE_MEMBRANE(mixed, "By strains and stretches.") { return g11 * s1; }
namespace drape::elements {
/// Two vertices by their numbers.
struct tied {
  static constexpr int vertices = 2;
  static constexpr EnergyRole role = EnergyRole::bending;
  static Stencils of(const Level&) { return Stencils{{0, 60}}; }
  static ElementOrder order(const Level& level) { return ElementOrder::of(of(level), level.rest.vertices); }
};
}  // namespace drape::elements
DRAPE_ELEMENT(tie, tied, "Pulled together.") { return 5 * d[0].squaredNorm(); }
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
DRAPE_MEMBRANE(tension, "On the area.", Positioned) { return 3 * J; }
DRAPE_ELEMENT(doubled_area, triangles, "On the area.", Positioned) { return d[0].cross(d[1]).norm(); }
DRAPE_METRIC(above, "With parameters.", "m", neither, Woven) { return warp * x.col(2).minCoeff(); }

using namespace drape;

namespace {

Level sheet() { return Level::of(0, grid({1, 1}, 9, 8, Diagonals::criss_cross)); }

Positions wrinkled(const Level& level, double size = 0.02) { return shaken(level.rest.vertices, size, 3); }

/// The energy has this role and midpoint factor, its derivatives agree with differences of the value, and the
/// gradient's value is the value.
template <class Formula>
void check_formula(EnergyRole role, std::optional<double> factor) {
  const Formula energy({});
  CHECK(energy.role() == role);
  CHECK(energy.midpoint_factor() == factor);
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
  Positions product;
  hessian_of(*bound, x, Projection::none).multiply(direction, product);
  CHECK((product - change).norm() <= 1e-6 * change.norm());
}

}  // namespace

TEST_CASE("energy_formula: derivatives, role and midpoint factor follow from the formula") {
  using enum EnergyRole;
  const auto none = std::nullopt;
  check_formula<MembraneFormula<formulas::woven>>(membrane, 1);
  check_formula<MembraneFormula<formulas::every_function>>(membrane, 1);
  check_formula<MembraneFormula<formulas::stretches_of_stvk>>(membrane, 1);
  check_formula<MembraneFormula<formulas::seam>>(membrane, none);
  check_formula<MembraneFormula<formulas::sized>>(membrane, none);
  check_formula<MembraneFormula<formulas::at_rest>>(membrane, none);
  check_formula<MembraneFormula<formulas::tension>>(position, 1);
  check_formula<ElementFormula<formulas::tie, elements::tied>>(bending, none);
  check_formula<ElementFormula<formulas::stvk_by_edges, elements::triangles>>(membrane, 1);
  check_formula<ElementFormula<formulas::doubled_area, elements::triangles>>(position, 1);
  check_formula<ElementFormula<formulas::quadratic, elements::hinges>>(bending, 2);
  check_formula<FoldFormula<formulas::fold>>(bending, 2);
  check_formula<FoldFormula<formulas::crease>>(bending, none);
  check_formula<VertexFormula<formulas::wind>>(external, 1);
  check_formula<VertexFormula<formulas::patch_wind>>(external, none);
  check_formula<VertexFormula<formulas::gust>>(external, none);
  check_formula<VertexFormula<formulas::spring>>(position, none);
  CHECK_FALSE(FoldFormula<formulas::late>({}).midpoint_factor());
  CHECK(ElementFormula<formulas::quadratic, elements::hinges>({}).plate_stiffness(Material()) ==
        Approx(FoldFormula<formulas::fold>({}).plate_stiffness(Material())).epsilon(1e-3));
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

TEST_CASE("energy_formula: grain turns warp") {
  const Level level = sheet();
  const Positions x = level.rest.vertices * Eigen::Vector3d(1, 1.1, 1).asDiagonal();
  const double g = 0.5 * (1.1 * 1.1 - 1);
  for (const auto& [grain, stiffness] : {std::pair(0., 5e2), {90., 2e3}}) {
    TriangleMesh mesh = level.rest;
    mesh.warp = warp_at(mesh, grain);
    const auto energy = MembraneFormula<formulas::woven>({}).bind(Level::of(0, mesh), Material());
    CHECK(energy->value(x) == Approx(0.5 * stiffness * g * g));
  }
}

TEST_CASE("energy_formula: a law by strains, by stretches and by edge vectors is one energy") {
  const Level level = sheet();
  const Material material;
  const auto strains = MembraneFormula<formulas::strains_of_stvk>({}).bind(level, material),
             stretches = MembraneFormula<formulas::stretches_of_stvk>({}).bind(level, material),
             edges = ElementFormula<formulas::stvk_by_edges, elements::triangles>({}).bind(level, material);
  for (const double size : {0.002, 0.02}) {
    const Positions x = wrinkled(level, size), g = gradient_of(*strains, x);
    const Eigen::MatrixXd h = dense(hessian_of(*strains, x, Projection::clamp));
    for (const BoundEnergy* other : {stretches.get(), edges.get()}) {
      CHECK(other->stencils() == strains->stencils());
      CHECK(other->value(x) == Approx(strains->value(x)).epsilon(1e-11));
      CHECK((gradient_of(*other, x) - g).norm() <= 1e-11 * g.norm());
      CHECK((dense(hessian_of(*other, x, Projection::clamp)) - h).norm() <= 1e-9 * h.norm());
    }
  }
  CHECK_THROWS_WITH(MembraneFormula<formulas::mixed>({}),
                    Catch::Contains("uses Green strains (g11, g22, g12) and principal stretches (s1, s2)"));
}

TEST_CASE("energy_formula: elements of vertices that a level does not have are refused") {
  const ElementFormula<formulas::tie, elements::tied> tie({});
  CHECK(tie.plate_stiffness(Material()) == 0);
  CHECK_THROWS_WITH(tie.bind(Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way)), Material()),
                    Catch::Contains("has a vertex that level 0"));
}

TEST_CASE("metric_formula: a metric has the parameters of its struct") {
  Registry registry;
  registry.add<Metric, formulas::above>("above", "A.");
  CHECK(registry.find("metric", "above")->schema.parameters.size() == 2);
}
