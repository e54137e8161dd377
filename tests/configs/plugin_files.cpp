// --plugin FILE.cpp: a plugin's source is compiled once and loaded.

#include <catch2/catch.hpp>

#include "tests/support/command.h"
#include "tests/support/folders.h"

using Catch::Contains;
using Catch::EndsWith;

namespace {

const std::string energy_file = R"(#include "core/numerics/formulas/energy_formula.h"
#include "stiffness.h"

DRAPE_MEMBRANE(rubber, "Isotropic.") {
  return stiffness * (g11 * g11 + g22 * g22 + 2 * g12 * g12);
}
)";

/// A folder with a plugin's source, an experiment with it, and a cache.
struct PluginFolder : Scratch {
  PluginFolder() {
    write("rubber.cpp", energy_file);
    write("stiffness.h", "constexpr double stiffness = 20;\n");
    write("drape.yaml",
          "name: rubber\ncloth: {side: 0.2, vertices: 16}\nlevels: 2\npins: [{region: box, lower: [0, 0, 0], "
          "upper: [0, 1, 0]}]\nenergies: [rubber, hinge, gravity]\nmethods: {pcs: {}}\n");
  }
  std::string environment() const { return "XDG_CACHE_HOME=" + (path / "cache").string(); }
  Ended with(const std::string& arguments) const { return drape_with(arguments, path, environment()); }
  std::string refused(const std::string& arguments, const std::string& more = "") const {
    return refused_by(arguments, path, environment() + " " + more);
  }
};

}  // namespace

TEST_CASE("A plugin's source is compiled, loaded and run, and kept for the next command") {
  const PluginFolder folder;
  const Ended first = folder.with("run drape.yaml --plugin rubber.cpp -q --no-report -o results");
  INFO(first.err);
  CHECK(first.exit_code == 0);
  CHECK_THAT(first.err, Contains("compiling ") && Contains("rubber.cpp: "));
  CHECK(std::filesystem::exists(folder / "results/results.json"));

  for (const char* command :
       {"check drape.yaml", "check-energy rubber", "describe rubber", "list energy", "schema"}) {
    const Ended ended = folder.with(std::string(command) + " --plugin rubber.cpp");
    INFO(command << ": " << ended.err);
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.err, !Contains("compiling"));
  }
  CHECK_THAT(folder.with("list energy --plugin rubber.cpp").out, Contains("rubber"));

  folder.write("sweep.yaml",
               "name: sweep\nbase: drape.yaml\nablation: [{name: as it is}, {name: larger, set: {cloth.side: "
               "0.3}}]\n");
  const Ended sweep = folder.with("sweep sweep.yaml --plugin rubber.cpp -q -o swept");
  INFO(sweep.err << sweep.out);
  CHECK(sweep.exit_code == 0);

  SECTION("a header of its own that changes is compiled again") {
    folder.write("stiffness.h", "constexpr double stiffness = 21;\n");
    CHECK_THAT(folder.with("list energy --plugin rubber.cpp").err, Contains("compiling"));
    CHECK_THAT(folder.with("list energy --plugin rubber.cpp").err, !Contains("compiling"));
  }
}

TEST_CASE("What the compiler refuses is shown with the file's lines, and nothing is run or kept") {
  const PluginFolder folder;
  folder.write("rubber.cpp", replaced(energy_file, "g22 * g22", "g23 * g22"));
  for (int time = 0; time < 2; ++time) {
    const std::string err = folder.refused("run drape.yaml --plugin rubber.cpp");
    CHECK_THAT(err, Contains("rubber.cpp:5:") && Contains("g23") &&
                        Contains("return stiffness * (g11 * g11 + g23 * g22") &&
                        Contains("error: --plugin ") && Contains("rubber.cpp: does not compile"));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "results"));
  folder.write("fold.cpp", R"(#include "core/numerics/formulas/energy_formula.h"
DRAPE_PARAMETERS(Crease, (rest, 0.3, "rad", -3, 3, "angle at rest"));
DRAPE_FOLD(fold, "A crease.", Crease) { return k * square(theta - rest); }
)");
  CHECK_THAT(folder.refused("list energy --plugin fold.cpp"),
             Contains("a parameter has the name of a symbol of the formula"));
}

TEST_CASE("What a plugin throws or fails to return ends a command with a message") {
  const PluginFolder folder;
  folder.write("bad.cpp", R"(#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/plugin.h"
using namespace drape;
struct Bound : BoundEnergy {
  double value(const Positions&) const override { throw 42; }
  double add_gradient(const Positions& x, Positions&) const override { return value(x); }
  Stencils stencils() const override { return Stencils::Zero(1, 1); }
  void add_hessian(const Positions&, Projection, BlockSink&) const override {}
};
struct Null : Energy {
  EnergyRole role() const override { return EnergyRole::position; }
  std::unique_ptr<BoundEnergy> bind(const Level&, const Material&) const override { return nullptr; }
};
struct Throws : Null {
  std::unique_ptr<BoundEnergy> bind(const Level&, const Material&) const override {
    return std::make_unique<Bound>();
  }
};
struct Refuses : Null {
  Refuses() { throw 42; }
};
DRAPE_PLUGIN(registry) {
  registry.add<Energy, Null>("nothing", "Binds to nothing.");
  registry.add<Energy, Throws>("throws", "Throws a number.");
  registry.add<Energy, Refuses>("refuses", "Throws a number at once.");
}
)");
  const auto refusal = [&](const std::string& arguments) {
    return folder.refused(arguments + " --plugin bad.cpp");
  };
  const std::string other = "an exception that is no std::exception\n";
  CHECK_THAT(refusal("check-energy nothing"),
             EndsWith("error: bind returned null; return an object, which may "
                      "have no elements\n"));
  CHECK(refusal("check-energy throws") == "error: " + other);
  CHECK(refusal("check-energy refuses") == "error: energy: refuses: " + other);
  CHECK_THAT(refusal("check drape.yaml --set energies=[throws]"), EndsWith(other));
}

TEST_CASE("A library is no source of a plugin, and a source may have any name") {
  const PluginFolder folder;
  const std::string library = (folders::test_plugins() / "good/libgood.so").string();
  CHECK(
      folder.refused("list energy --plugin " + library) ==
      "error: --plugin " + library +
          ": is compiled, and --plugin takes a source; put the folder of the library into DRAPE_PLUGIN_PATH "
          "instead, as in export DRAPE_PLUGIN_PATH=" +
          (folders::test_plugins() / "good").string() + "\n");
  folder.write("text.so", "no C++\n");
  CHECK_THAT(folder.refused("list energy --plugin text.so"),
             Contains("text.so:1:") && Contains("text.so: does not compile"));
}

TEST_CASE("A plugin's source without a compiler, or that is no plugin, is refused") {
  const PluginFolder folder;
  CHECK_THAT(
      folder.refused("list energy --plugin rubber.cpp", "CXX=/nowhere/c++"),
      Contains(
          "--plugin: there is no compiler /nowhere/c++; install it (Debian's package g++), or name one"));
  CHECK_THAT(folder.refused("list energy --plugin none.cpp"),
             Contains("none.cpp") && Contains("No such file"));
  folder.write("empty.cpp", "int main() {}\n");
  CHECK_THAT(folder.refused("list energy --plugin empty.cpp"), Contains("is not a drape plugin"));
}

TEST_CASE("A cache or a folder for temporary files that is not there is named, with its variable") {
  const PluginFolder folder;
  const std::string list = "list energy --plugin rubber.cpp";
  CHECK(folder.refused(list, "TMPDIR=/nonexistent") ==
        "error: --plugin: the folder for temporary files, TMPDIR=/nonexistent, is not there (No such file or "
        "directory); make it, or name another in the variable TMPDIR\n");
  const std::string err = refused_by(list, folder.path, "XDG_CACHE_HOME=/proc/none");
  CHECK_THAT(err, Contains("error: --plugin: cannot make /proc/none/drape/rubber-") &&
                      EndsWith("for the library (No such file or directory); name a folder for it in the "
                               "variable XDG_CACHE_HOME\n"));
}
