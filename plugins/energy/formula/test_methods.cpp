// The laws of conformance*.yaml, which README.md shows, each from YAML alone, under every method.

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/support/conformance.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

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
         energies + "methods: {pcs: {compression: buckling}, cascadic: {}, newton: {}}\n";
}

std::string without_spaces_and_comments(const std::string& text) {
  return std::regex_replace(text, std::regex("#[^\n]*|\\s"), "");
}

}  // namespace

TEST_CASE("every law converges under pcs, cascadic and newton") {
  const RegistryEntry* entry = test_registry().find("energy", "formula");
  REQUIRE(entry);
  auto laws = more_conformance_parameters(*entry);
  laws.emplace_back("conformance", conformance_parameters(*entry));
  REQUIRE(laws.size() == 6);
  std::ifstream file(std::filesystem::path(folders::source()) / "plugins/energy/formula/README.md");
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
