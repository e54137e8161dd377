// A formula in an experiment: its keys, its errors, its runs.

#include <catch2/catch.hpp>

#include "core/app/experiment/describe.h"
#include "core/app/files/yaml_file.h"
#include "tests/support/command.h"
#include "tests/support/registry.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

const std::string experiment_text = R"yaml(name: cloth
cloth: {side: 0.2, vertices: 25}
levels: 2
pins: [{region: box, lower: [0, 0, 0], upper: [0, 0.2, 0]}]
energies:
  - {type: formula, name: orthotropic, constants: {warp: {value: 200, unit: N/m}, nu12: 0.2},
     where: {sum: "g11 + g22"},
     density: "warp*(g11^2 + nu12*sum^2
               + g22^2 + g12^2)"}
  - hinge
  - gravity
methods: {newton: {}}
)yaml";

/// The formula's, under the first load.
double stretched_energy(const Experiment& e) {
  const auto scene = scene_of(e);
  return scene->model(0)->energy_parts(1.1 * scene->hierarchy.levels[0].rest.vertices)[0].second;
}

}  // namespace

TEST_CASE("a constant is a key of its energy, with and without a unit") {
  const double own = stretched_energy(experiment_from(experiment_text));
  const auto with = [](const std::string& key, const std::string& value) {
    return stretched_energy(experiment_from(experiment_text, {{key, value}}));
  };
  CHECK(with("energies.orthotropic.warp", "400") == Approx(2 * own));
  CHECK(with("energies.0.warp", "400") == Approx(2 * own));
  CHECK(with("energies.orthotropic.constants.warp", "400") == Approx(2 * own));
  CHECK(with("energies.orthotropic.constants.warp.value", "400") == Approx(2 * own));
  CHECK(with("energies.orthotropic.nu12", "0.7") > own);
  CHECK(with("energies.orthotropic.density", "warp*g11^2") < own);
}

TEST_CASE("a schedule changes a constant, and the saved config reads back as the same energy") {
  const Experiment e = experiment_from(experiment_text);
  CHECK(e.energies[0].name == "orthotropic");
  const Experiment again = experiment_from(to_yaml(e.resolved));
  CHECK(stretched_energy(again) == stretched_energy(e));
  CHECK(again.resolved.one_line() == e.resolved.one_line());
  const std::string schedule =
      "schedule: {steps: 2, keys: [{parameter: energies.orthotropic.warp, times: [0, 1], values: [100, "
      "300]}]}\n";
  CHECK(stretched_energy(experiment_from(experiment_text + schedule)) == Approx(0.5 * stretched_energy(e)));
}

TEST_CASE("a constant comes before the material's symbol of its name") {
  const std::string by_nu = replaced(experiment_text, "nu12*sum", "nu*sum"),
                    own = replaced(by_nu, "nu12: 0.2", "nu: 0.2"),
                    material = replaced(by_nu, ", nu12: 0.2", "");
  CHECK(stretched_energy(experiment_from(own)) == stretched_energy(experiment_from(experiment_text)));
  CHECK(stretched_energy(experiment_from(material)) != stretched_energy(experiment_from(own)));
}

TEST_CASE("check has a line on derivatives and one on the state of rest") {
  const Material material;
  const auto lines = [&](const std::string& yaml) {
    return make_plugin_from<Energy>("{type: formula, " + yaml + "}")->remarks(material);
  };
  const auto triangle = lines("density: \"thickness*E*(g11 - 0.01)^2\"");
  REQUIRE(triangle.size() == 2);
  CHECK_THAT(triangle[0], Catch::StartsWith("derivatives agree with finite differences"));
  CHECK(triangle[1] == "stress at rest: -0.509, 0, shear 0 N/m");
  // Differences with the usual step of 1e-5 m are off by 1 % here.
  CHECK_THAT(lines("density: \"20*(exp(3000*g11^2) - 1)\"")[0],
             Catch::StartsWith("derivatives agree with finite differences"));
  CHECK_THAT(lines("density: \"20*(exp(1e6*g11^2) - 1)\"")[0],
             Catch::Contains("not finite at strains of 0.05"));
  const auto hinge = lines("per: hinge, energy: \"k*bend^2\"");
  CHECK_THAT(hinge[0], Catch::StartsWith("derivatives agree with finite differences"));
  CHECK(hinge[1] == "moment per length of a flat edge: 0 N");
  const auto vertex = lines("per: vertex, constants: {g: {value: 2, unit: m/s^2}}, energy: \"mass*g*z\"");
  CHECK(vertex[1] == "acceleration at the origin: 0, 0, -2 m/s²");
}

TEST_CASE("describe lists what formulas may use") {
  const RegistryEntry* entry = test_registry().find("energy", "formula");
  REQUIRE(entry);
  const std::string page = describe(*entry);
  for (const char* word : {"per: triangle", "g12", "per: hinge", "bend", "per: vertex", "mass", "E_bend",
                           "expm1", "if(condition, a, b)"})
    CHECK_THAT(page, Catch::Contains(word));
}
