// Formulas of the compiled plugins have their values and derivatives, and formulas run under every method.

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <regex>

#include "core/numerics/patterns/generate.h"
#include "tests/support/conformance.h"
#include "tests/support/evaluate.h"
#include "tests/support/registry.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

const char* const stvk =
    "{type: formula, density: \"thickness*(mu*(g11^2 + g22^2 + 2*g12^2) + lambda/2*(g11 + g22)^2)\"}";
const char* const neo_hookean =
    "{type: formula, where: {l: log(J)}, density: \"thickness*(mu*(g11 + g22 - l) + lambda/2*l^2)\"}";
const char* const hinge = "{type: formula, per: hinge, energy: \"3*k*length^2/area*(theta - rest)^2\"}";

Level curved_level() {
  TriangleMesh mesh = random_triangulation({0.6, 0.5}, 200, 8);
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i)
    mesh.vertices(i, 2) = 0.1 * std::sin(5 * mesh.vertices(i, 0)) * std::cos(4 * mesh.vertices(i, 1));
  return Level::of(0, mesh);
}

/// With the largest entry of `other` as the unit.
double largest_difference(const std::vector<double>& own, const std::vector<double>& other) {
  REQUIRE(own.size() == other.size());
  const auto size = static_cast<Eigen::Index>(own.size());
  const Eigen::Map<const Eigen::VectorXd> a(own.data(), size), b(other.data(), size);
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// A membrane by its density, in which m is 30 N/m.
std::shared_ptr<Energy> membrane(const std::string& density) {
  return make_plugin_from<Energy>("{type: formula, constants: {m: {value: 30, unit: N/m}}, density: \"" +
                                  density + "\"}");
}

void check_agreement(const std::string& formula, const std::string& plugin) {
  INFO(plugin);
  constexpr double tolerance = 1e-12;
  const Level level = curved_level();
  Material material;
  material.thickness = 3e-4;
  const auto own = make_plugin_from<Energy>(formula), other = make_plugin_from<Energy>(plugin);
  CHECK(own->role() == other->role());
  CHECK(own->midpoint_factor() == other->midpoint_factor());
  CHECK(own->plate_stiffness(material) ==
        Approx(other->plate_stiffness(material)).epsilon(1e-3).margin(0));  // rolled, not bent in the limit
  const auto a = own->bind(level, material), b = other->bind(level, material);
  CHECK(a->stencils() == b->stencils());
  for (const double size : {1e-4, 2e-3, 0.01}) {
    INFO("noise of " << size << " m");
    const Positions x = level.rest.vertices + noise(level.vertex_count(), size, 3);
    CHECK(a->value(x) == Approx(b->value(x)).epsilon(tolerance).margin(0));
    const Positions ga = gradient_of(*a, x), gb = gradient_of(*b, x);
    CHECK((ga - gb).cwiseAbs().maxCoeff() <= tolerance * gb.cwiseAbs().maxCoeff());
    for (const Projection projection : {Projection(Projection::none), Projection(Projection::clamp)})
      CHECK(largest_difference(hessian_of(*a, x, projection).values, hessian_of(*b, x, projection).values) <=
            tolerance);
  }
}

/// A square pinned along one side, under gravity, with the energies that the law is not.
std::string experiment(const std::string& law) {
  const bool hinge = law.find("per: hinge") != std::string::npos,
             vertex = law.find("per: vertex") != std::string::npos;
  std::string energies = "  - gravity\n  - " + law + "\n";
  if (hinge || vertex) energies += "  - neo_hookean\n";
  if (!hinge) energies += "  - hinge\n";
  // A penalty on areas alone resists no shear.
  if (law.find("area_penalty") != std::string::npos) energies += "  - neo_hookean\n";
  return "name: law\n"
         "cloth: {side: 0.2, columns: 6, rows: 6}\n"
         "levels: 2\n"
         "pins:\n  - {region: box, lower: [0, 0, 0], upper: [0, 0.2, 0]}\n"
         "energies:\n" +
         energies + "methods: {pcs: {membranes: effective}, cascadic: {}, newton: {}}\n";
}

std::string without_spaces_and_comments(const std::string& text) {
  return std::regex_replace(text, std::regex("#[^\n]*|\\s"), "");
}

}  // namespace

TEST_CASE("formulas agree with the compiled energies") {
  check_agreement(stvk, "stvk");
  check_agreement(neo_hookean, "neo_hookean");
  check_agreement(hinge, "hinge");
}

TEST_CASE("a formula by strains, stretches and both is one law") {
  const Level level = curved_level();
  const Material material;
  const auto bind = [&](const std::string& density) { return membrane(density)->bind(level, material); };
  const auto strains = bind("m*(g11 + g22)^2 + m*(J - 1)^2"),
             stretches = bind("m*(s1^2 + s2^2 - 2)^2/4 + m*(s1*s2 - 1)^2"),
             both = bind("m*(g11 + g22)^2 + m*(s1*s2 - 1)^2 + 0*s1");
  for (const double size : {0.002, 0.01}) {
    const Positions x = level.rest.vertices + noise(level.vertex_count(), size, 3);
    const Positions g = gradient_of(*strains, x);
    const std::vector<double> h = hessian_of(*strains, x, Projection::none).values;
    for (const BoundEnergy* other : {stretches.get(), both.get()}) {
      CHECK(other->value(x) == Approx(strains->value(x)).epsilon(1e-12));
      CHECK((gradient_of(*other, x) - g).cwiseAbs().maxCoeff() <= 1e-11 * g.cwiseAbs().maxCoeff());
      CHECK(largest_difference(hessian_of(*other, x, Projection::none).values, h) <= 1e-9);
    }
  }
}

TEST_CASE("principal stretches have derivatives where they are equal") {
  const Level level = Level::of(0, grid({0.1, 0.1}, 3, 3, Diagonals::one_way));
  const auto bound = membrane("m*(s1^3 + s2^3 + (s1*s2)^-3 - 3)")->bind(level, Material());
  for (const double stretch : {1.0, 1.1}) {
    const Positions x = stretch * level.rest.vertices;
    const Eigen::MatrixXd h = dense(hessian_of(*bound, x, Projection::none));
    CHECK((h - hessian_by_differences(*bound, x, 1e-5)).norm() <= 1e-7 * h.norm());
  }
}

TEST_CASE("an isotropic formula buckles below the mesh as the compiled law does") {
  const Level level = Level::of(0, grid({0.1, 0.1}, 4, 4, Diagonals::one_way));
  const Material material;
  const auto own = make_plugin_from<Energy>(stvk)->bind_buckling(level, material, 1e-5),
             other = make_plugin_from<Energy>("stvk")->bind_buckling(level, material, 1e-5);
  for (const double size : {1e-4, 0.004}) {
    const Positions x = 0.98 * level.rest.vertices + noise(level.vertex_count(), size, 3);
    CHECK(own->value(x) == Approx(other->value(x)).epsilon(1e-9));
    const Positions g = gradient_of(*other, x);
    CHECK((gradient_of(*own, x) - g).cwiseAbs().maxCoeff() <= 1e-7 * g.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("a law that is isotropic in places alone keeps its directions below the mesh") {
  const std::string law = "m*(g11^2 + g22^2 + 2*g12^2) + if(u > edge, 50*m*g11^2, 0)";
  const auto banded = make_plugin_from<Energy>(
      "{type: formula, constants: {m: {value: 30, unit: N/m}, edge: {value: 0.05, unit: m}}, density: \"" +
      law + "\"}");
  const Level level = Level::of(0, grid({0.1, 0.1}, 4, 4, Diagonals::one_way));
  const Positions x = level.rest.vertices * Eigen::Vector3d(1.01, 1.1, 1).asDiagonal();  // taut
  CHECK(banded->bind_buckling(level, Material(), 1e-5)->value(x) ==
        Approx(banded->bind(level, Material())->value(x)).epsilon(1e-9));
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

TEST_CASE("a formula that is not finite at rest is refused") {
  const auto refused = [](const std::string& yaml, const std::string& message) {
    CHECK_THROWS_WITH(make_plugin_from<Energy>("{type: formula, " + yaml + "}"), Catch::Contains(message));
  };
  refused("density: \"thickness*E*log(g11)\"", "the energy is not finite on the rest shape");
  refused("density: \"thickness*E*sqrt(g11)\"", "has forces that are not finite on the rest shape");
  refused("density: \"thickness*E*max(g11, 0)^1.5\"", "the stiffness of the rest shape is not finite");
}

TEST_CASE("a formula of a place need be finite only where the cloth is") {
  const auto energy = make_plugin_from<Energy>(
      "{type: formula, constants: {h: {value: 0.2, unit: m}}, density: \"thickness*E*(h/w)*(g11^2 + "
      "g22^2)\"}");
  TriangleMesh mesh = grid({0.1, 0.1}, 3, 3, Diagonals::one_way);
  CHECK_THROWS_WITH(energy->bind(Level::of(0, mesh), Material()),
                    Catch::Contains("not finite on the rest shape of level 0"));
  mesh.vertices.col(2).setConstant(0.4);
  CHECK(energy->bind(Level::of(0, mesh), Material())->value(1.1 * mesh.vertices) > 0);
}

TEST_CASE("gravity by a formula is linear, as the plugin is") {
  const Level level = curved_level();
  const Material material;
  const auto energy = make_plugin_from<Energy>(
      "{type: formula, per: vertex, constants: {g: {value: 9.81, unit: m/s^2}}, energy: \"mass*g*(z - w)\"}");
  CHECK(energy->role() == EnergyRole::external);
  const auto bound = energy->bind(level, material),
             gravity = make_plugin_from<Energy>("gravity")->bind(level, material);
  CHECK(bound->stencils().rows() == 0);
  const Positions x = level.rest.vertices + noise(level.vertex_count(), 0.1, 3);
  CHECK(bound->value(x) == Approx(gravity->value(x) - gravity->value(level.rest.vertices)));
  CHECK((gradient_of(*bound, x) - gradient_of(*gravity, x)).norm() <= 1e-15);
  CHECK(bound->value(level.rest.vertices) == Approx(0).margin(1e-15));
}

TEST_CASE("a vertex's law with a kink, or with a constant that is 0, has no constant forces") {
  const Level level = Level::of(0, grid({0.1, 0.1}, 3, 3, Diagonals::one_way));
  Positions x = level.rest.vertices;
  x.col(2).setConstant(0.5);
  const auto bound = [&](double p, const std::string& law) {
    return make_plugin_from<Energy>(
               "{type: formula, per: vertex, constants: {p: {value: " + std::to_string(p) +
               ", unit: Pa}, h: {value: 0.2, unit: m}}, energy: \"" + law + "\"}")
        ->bind(level, Material());
  };
  for (const std::string law : {"p*area*max(z, 0)", "p*area*abs(z)", "if(z > h, p*area*z, 0)"}) {
    INFO(law);
    const auto kinked = bound(2, law);
    CHECK(kinked->stencils().rows() == level.vertex_count());
    CHECK(kinked->value(x) == Approx(0.01));
    CHECK(gradient_of(*kinked, x).col(2).sum() == Approx(0.02));
  }
  // A schedule may change the constant, and stencils stay.
  CHECK(bound(0, "p*area*z*(z/h)")->stencils().rows() == level.vertex_count());
  CHECK(bound(0, "p*area*z/h*h - p*area*x*if(p > p, 2, 3)")->stencils().rows() == 0);
}

TEST_CASE("an energy of -infinity counts as outside the domain") {
  const Level level = Level::of(0, grid({0.1, 0.1}, 3, 3, Diagonals::one_way));
  const auto bound = make_plugin_from<Energy>("{type: formula, density: \"thickness*E*log(2*g11 + 1)\"}")
                         ->bind(level, Material());
  Positions x = level.rest.vertices;
  x.col(0).setZero();
  CHECK(bound->value(x) == std::numeric_limits<double>::infinity());
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

TEST_CASE("a wind by the position z lifts, one by the rest shape does not") {
  const Level level = Level::of(0, grid({0.6, 0.6}, 4, 4, Diagonals::one_way));
  const auto lift = [&](const std::string& height) {
    const auto wind = make_plugin_from<Energy>(
        "{type: formula, per: vertex, constants: {p: {value: 10, unit: Pa}, h: {value: 0.7, unit: m}}, "
        "energy: \"-p*area*x*exp(" +
        height + "/h)\"}");
    return -gradient_of(*wind->bind(level, Material()), level.rest.vertices).col(2).sum();
  };
  CHECK(lift("z") == Approx(10 * 0.36 * 0.3 / 0.7));
  CHECK(lift("v") == 0);
}

TEST_CASE("a triangle's law that depends on its size has no midpoint factor") {
  const auto factor = [](const std::string& law) {
    return make_plugin_from<Energy>("{type: formula, constants: {c: {value: 1, unit: J}}, " + law + "}")
        ->midpoint_factor();
  };
  CHECK_FALSE(factor("energy: \"c*(J - 1)^2\""));
  CHECK_FALSE(factor("density: \"c/area*g11^2\""));
  CHECK(*factor("energy: \"E*thickness*area*(J - 1)^2\"") == Approx(1));
}
