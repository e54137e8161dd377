// Formulas of the compiled plugins have their values and derivatives, and formulas run under every method.

#include <catch2/catch.hpp>
#include <fstream>
#include <regex>

#include "core/numerics/patterns/generate.h"
#include "tests/support/conformance.h"
#include "tests/support/evaluate.h"
#include "tests/support/registry.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

const std::string stvk = "density: \"thickness*(mu*(g11^2 + g22^2 + 2*g12^2) + lambda/2*(g11 + g22)^2)\"";

std::shared_ptr<Energy> by_formula(const std::string& keys) {
  return make_plugin_from<Energy>("{type: formula, " + keys + "}");
}

/// A membrane by its density, in which m is 30 N/m.
std::shared_ptr<Energy> membrane(const std::string& density) {
  return by_formula("constants: {m: {value: 30, unit: N/m}}, density: \"" + density + "\"");
}

/// An energy of vertices, in which h is 0.2 m.
std::shared_ptr<Energy> load(const std::string& energy, const std::string& pascals = "2") {
  return by_formula("per: vertex, constants: {p: {value: " + pascals +
                    ", unit: Pa}, h: {value: 0.2, unit: m}}, energy: \"" + energy + "\"");
}

Level curved_level() {
  TriangleMesh mesh = random_triangulation({0.6, 0.5}, 200, 8);
  for (auto v : mesh.vertices.rowwise()) v[2] = 0.1 * std::sin(5 * v[0]) * std::cos(4 * v[1]);
  return Level::of(0, mesh);
}

Level square(int n) { return Level::of(0, grid({0.1, 0.1}, n, n, Diagonals::one_way)); }

Positions moved(const Positions& x, double size) { return x + noise(x.rows(), size, 3); }

/// Value, gradient and Hessian, to these parts of the largest entry.
void check_same(const BoundEnergy& own, const BoundEnergy& other, const Positions& x, double of_value,
                double of_gradient, double of_hessian, Projection projection = Projection::none) {
  CHECK(own.value(x) == Approx(other.value(x)).epsilon(of_value).margin(0));
  const Positions g = gradient_of(other, x);
  CHECK((gradient_of(own, x) - g).cwiseAbs().maxCoeff() <= of_gradient * g.cwiseAbs().maxCoeff());
  const Eigen::MatrixXd h = dense(hessian_of(other, x, projection));
  CHECK((dense(hessian_of(own, x, projection)) - h).cwiseAbs().maxCoeff() <=
        of_hessian * h.cwiseAbs().maxCoeff());
}

void check_agreement(const std::string& keys, const std::string& plugin) {
  INFO(plugin);
  const Level level = curved_level();
  Material material;
  material.thickness = 3e-4;
  const auto own = by_formula(keys), other = make_plugin_from<Energy>(plugin);
  CHECK(own->role() == other->role());
  CHECK(own->midpoint_factor() == other->midpoint_factor());
  CHECK(own->plate_stiffness(material) ==
        Approx(other->plate_stiffness(material)).epsilon(1e-3).margin(0));  // rolled, not bent in the limit
  const auto a = own->bind(level, material), b = other->bind(level, material);
  CHECK(a->stencils() == b->stencils());
  for (const double size : {1e-4, 2e-3, 0.01})
    for (const auto projection : {Projection::none, Projection::clamp}) {
      INFO("noise of " << size << " m");
      check_same(*a, *b, moved(level.rest.vertices, size), 1e-12, 1e-12, 1e-12, projection);
    }
}

/// A square pinned along one side, under gravity, with the energies that the law is not.
std::string experiment(const std::string& law) {
  const auto is = [&](const char* word) { return law.find(word) != std::string::npos; };
  std::string energies = "  - gravity\n  - " + law + "\n";
  // A penalty on areas alone resists no shear.
  if (is("per: hinge") || is("per: vertex") || is("area_penalty")) energies += "  - neo_hookean\n";
  if (!is("per: hinge")) energies += "  - hinge\n";
  return "name: law\ncloth: {side: 0.2, columns: 6, rows: 6}\nlevels: 2\n"
         "pins: [{region: box, lower: [0, 0, 0], upper: [0, 0.2, 0]}]\nenergies:\n" +
         energies + "methods: {pcs: {membranes: effective}, cascadic: {}, newton: {}}\n";
}

std::string without_spaces_and_comments(const std::string& text) {
  return std::regex_replace(text, std::regex("#[^\n]*|\\s"), "");
}

}  // namespace

TEST_CASE("formulas agree with the compiled energies") {
  check_agreement(stvk, "stvk");
  check_agreement("where: {l: log(J)}, density: \"thickness*(mu*(g11 + g22 - l) + lambda/2*l^2)\"",
                  "neo_hookean");
  check_agreement("per: hinge, energy: \"3*k*length^2/area*(theta - rest)^2\"", "hinge");
}

TEST_CASE("a formula by strains, stretches and both is one law") {
  const Level level = curved_level();
  const auto bind = [&](const std::string& density) { return membrane(density)->bind(level, Material()); };
  const auto strains = bind("m*(g11 + g22)^2 + m*(J - 1)^2"),
             stretches = bind("m*(s1^2 + s2^2 - 2)^2/4 + m*(s1*s2 - 1)^2"),
             both = bind("m*(g11 + g22)^2 + m*(s1*s2 - 1)^2 + 0*s1");
  for (const double size : {0.002, 0.01})
    for (const BoundEnergy* other : {stretches.get(), both.get()})
      check_same(*other, *strains, moved(level.rest.vertices, size), 1e-12, 1e-11, 1e-9);
}

TEST_CASE("principal stretches have derivatives where they are equal") {
  const Level level = square(3);
  const auto bound = membrane("m*(s1^3 + s2^3 + (s1*s2)^-3 - 3)")->bind(level, Material());
  for (const double stretch : {1.0, 1.1}) {
    const Positions x = stretch * level.rest.vertices;
    const Eigen::MatrixXd h = dense(hessian_of(*bound, x, Projection::none));
    CHECK((h - hessian_by_differences(*bound, x, 1e-5)).norm() <= 1e-7 * h.norm());
  }
}

TEST_CASE("an isotropic formula buckles below the mesh as the compiled law, another keeps its directions") {
  const Level level = square(4);
  const Material material;
  const auto own = by_formula(stvk)->bind_buckling(level, material, 1e-5),
             other = make_plugin_from<Energy>("stvk")->bind_buckling(level, material, 1e-5);
  for (const double size : {1e-4, 0.004}) {
    const Positions x = moved(0.98 * level.rest.vertices, size), g = gradient_of(*other, x);
    CHECK(own->value(x) == Approx(other->value(x)).epsilon(1e-9));
    CHECK((gradient_of(*own, x) - g).cwiseAbs().maxCoeff() <= 1e-7 * g.cwiseAbs().maxCoeff());
  }
  const auto banded = by_formula(  // isotropic in places alone
      "constants: {m: {value: 30, unit: N/m}, edge: {value: 0.05, unit: m}}, "
      "density: \"m*(g11^2 + g22^2 + 2*g12^2) + if(u > edge, 50*m*g11^2, 0)\"");
  const Positions taut = level.rest.vertices * Eigen::Vector3d(1.01, 1.1, 1).asDiagonal();
  CHECK(banded->bind_buckling(level, material, 1e-5)->value(taut) ==
        Approx(banded->bind(level, material)->value(taut)).epsilon(1e-9));
}

TEST_CASE("warp is along the grain, wherever corners begin") {
  const auto energy = [&](double grain, const Eigen::Vector3d& stretch) {
    TriangleMesh mesh = grid({0.1, 0.1}, 5, 5, Diagonals::criss_cross);
    mesh.warp = warp_at(mesh, grain);
    const auto bound = membrane("m*g11^2")->bind(Level::of(0, mesh), Material());
    return bound->value(mesh.vertices * stretch.asDiagonal());
  };
  const double all = 0.01 * 30 * std::pow(0.105, 2);
  CHECK(energy(0, {1.1, 1, 1}) == Approx(all));
  CHECK(energy(0, {1, 1.1, 1}) == Approx(0).margin(1e-18));
  CHECK(energy(90, {1, 1.1, 1}) == Approx(all));
  CHECK(energy(45, {1, 1.1, 1}) == Approx(all / 4));
}

TEST_CASE("a formula has to be finite at rest, where the cloth is, and -infinity is outside its domain") {
  const auto refused = [](const std::string& density, const std::string& message) {
    CHECK_THROWS_WITH(by_formula("density: \"" + density + "\""), Catch::Contains(message));
  };
  refused("thickness*E*log(g11)", "the energy is not finite on the rest shape");
  refused("thickness*E*sqrt(g11)", "has forces that are not finite on the rest shape");
  refused("thickness*E*max(g11, 0)^1.5", "the stiffness of the rest shape is not finite");
  const auto by_place =
      by_formula("constants: {h: {value: 0.2, unit: m}}, density: \"thickness*E*(h/w)*(g11^2 + g22^2)\"");
  TriangleMesh mesh = square(3).rest;
  CHECK_THROWS_WITH(by_place->bind(Level::of(0, mesh), Material()),
                    Catch::Contains("not finite on the rest shape of level 0"));
  mesh.vertices.col(2).setConstant(0.4);
  CHECK(by_place->bind(Level::of(0, mesh), Material())->value(1.1 * mesh.vertices) > 0);
  const auto pole = by_formula("density: \"thickness*E*log(2*g11 + 1)\"")->bind(square(3), Material());
  const Positions collapsed = square(3).rest.vertices * Eigen::Vector3d(0, 1, 1).asDiagonal();
  CHECK(pole->value(collapsed) == std::numeric_limits<double>::infinity());
}

TEST_CASE("gravity by a formula is linear, as the plugin is") {
  const Level level = curved_level();
  const auto energy =
      by_formula("per: vertex, constants: {g: {value: 9.81, unit: m/s^2}}, energy: \"mass*g*(z - w)\"");
  CHECK(energy->role() == EnergyRole::external);
  const auto bound = energy->bind(level, Material()),
             gravity = make_plugin_from<Energy>("gravity")->bind(level, Material());
  CHECK(bound->stencils().rows() == 0);
  const Positions x = moved(level.rest.vertices, 0.1);
  CHECK(bound->value(x) == Approx(gravity->value(x) - gravity->value(level.rest.vertices)));
  CHECK((gradient_of(*bound, x) - gradient_of(*gravity, x)).norm() <= 1e-15);
  CHECK(bound->value(level.rest.vertices) == Approx(0).margin(1e-15));
}

TEST_CASE("a vertex's law with a kink, or with a constant that is 0, has no constant forces") {
  const Level level = square(3);
  Positions x = level.rest.vertices;
  x.col(2).setConstant(0.5);
  for (const std::string law : {"p*area*max(z, 0)", "p*area*abs(z)", "if(z > h, p*area*z, 0)"}) {
    INFO(law);
    const auto kinked = load(law)->bind(level, Material());
    CHECK(kinked->stencils().rows() == level.vertex_count());
    CHECK(kinked->value(x) == Approx(0.01));
    CHECK(gradient_of(*kinked, x).col(2).sum() == Approx(0.02));
  }
  // A schedule may change the constant, and stencils stay.
  const auto stencils = [&](const std::string& law) {
    return load(law, "0")->bind(level, Material())->stencils().rows();
  };
  CHECK(stencils("p*area*z*(z/h)") == level.vertex_count());
  CHECK(stencils("p*area*z/h*h - p*area*x*if(p > p, 2, 3)") == 0);
}

// The laws of conformance*.yaml, which README.md shows, each from YAML alone.
TEST_CASE("every law converges under pcs, cascadic and newton") {
  const RegistryEntry* entry = test_registry().find("energy", "formula");
  REQUIRE(entry);
  const auto laws = conformance_parameters(*entry);
  REQUIRE(laws.size() == 6);
  std::ifstream file(folders::source() / "plugins/energy/formula/README.md");
  const std::string page = without_spaces_and_comments({std::istreambuf_iterator<char>(file), {}});
  for (const auto& [name, parameters] : laws) {
    INFO(name);
    CHECK(page.find("{type:formula," + without_spaces_and_comments(parameters) + "}") != std::string::npos);
    for (const std::string method : {"pcs", "cascadic", "newton"}) {
      INFO(name << " under " << method);
      const Solved solved = solve_yaml(experiment(conformance_config(*entry, parameters)), method);
      for (const LevelResult& level : solved.levels) CHECK(has_converged(level.outcome));
      CHECK(solved.model().force_residual(solved.x()) < 1e-2);
      CHECK((solved.x() - solved.rest()).norm() > 0.01);
    }
  }
}

TEST_CASE("a triangle's law that depends on its size has no midpoint factor") {
  const auto factor = [](const std::string& law) {
    return by_formula("constants: {c: {value: 1, unit: J}}, " + law)->midpoint_factor();
  };
  CHECK_FALSE(factor("energy: \"c*(J - 1)^2\""));
  CHECK_FALSE(factor("density: \"c/area*g11^2\""));
  CHECK(*factor("energy: \"E*thickness*area*(J - 1)^2\"") == Approx(1));
}
