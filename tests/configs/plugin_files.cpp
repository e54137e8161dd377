// --plugin FILE.cpp: a plugin's source is compiled once and loaded.

#include "tests/configs/runs.h"

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
  Ended with(const std::string& arguments) const {
    return drape_with(arguments, path, "XDG_CACHE_HOME=" + (path / "cache").string());
  }
  std::string refused(const std::string& arguments, const std::string& more = "") const {
    return refused_by(arguments, path, "XDG_CACHE_HOME=" + (path / "cache").string() + " " + more);
  }
};

const std::string listed = "list energy --plugin ";

}  // namespace

TEST_CASE("A plugin's source is compiled, loaded and run, and kept for the next command") {
  const PluginFolder folder;
  const Ended first = folder.with("run drape.yaml --plugin rubber.cpp -q --no-report --measure -o results");
  CHECK_THAT(first.err, Contains("compiling ") && Contains("rubber.cpp: "));
  CHECK(first.exit_code == 0);
  CHECK(fs::exists(folder / "results/results.json"));

  folder.write(
      "sweep.yaml",
      "name: sweep\nbase: drape.yaml\nablation: [{name: as it is}, {name: b, set: {cloth.side: 0.3}}]\n");
  for (const char* command : {"check drape.yaml", "check-energy rubber", "describe rubber", "list energy",
                              "schema", "sweep sweep.yaml -q -o swept"}) {
    const Ended ended = folder.with(std::string(command) + " --plugin rubber.cpp");
    INFO(command << ": " << ended.err);
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.err, !Contains("compiling"));
  }
  CHECK_THAT(folder.with(listed + "rubber.cpp").out, Contains("rubber"));
  REQUIRE(folder.with("run drape.yaml --plugin rubber.cpp -q --no-report -o unmeasured").exit_code == 0);
  CHECK_THAT(folder.with("table unmeasured").err, Contains("unknown energy \"rubber\""));
  const Ended table = folder.with("table unmeasured --plugin rubber.cpp");  // measures what the run left
  CHECK(table.exit_code == 0);
  CHECK(table.err == "");
  folder.write("stiffness.h", "constexpr double stiffness = 21;\n");  // a header of its own
  CHECK_THAT(folder.with(listed + "rubber.cpp").err, Contains("compiling"));
  CHECK_THAT(folder.with(listed + "rubber.cpp").err, !Contains("compiling"));
}

TEST_CASE("What the compiler refuses is shown with the file's lines, and nothing is run or kept") {
  const PluginFolder folder;
  folder.write("rubber.cpp", replaced(energy_file, "g22 * g22", "g23 * g22"));
  for (int time = 0; time < 2; ++time)
    CHECK_THAT(folder.refused("run drape.yaml --plugin rubber.cpp"),
               Contains("rubber.cpp:5:") && Contains("g23") &&
                   Contains("return stiffness * (g11 * g11 + g23 * g22") && Contains("error: --plugin ") &&
                   Contains("rubber.cpp: does not compile"));
  CHECK_FALSE(fs::exists(folder / "results"));
  folder.write("fold.cpp", R"(#include "core/numerics/formulas/energy_formula.h"
DRAPE_PARAMETERS(Crease, (rest, 0.3, "rad", -3, 3, "angle at rest"));
DRAPE_FOLD(fold, "A crease.", Crease) { return k * square(theta - rest); }
)");
  CHECK_THAT(folder.refused(listed + "fold.cpp"), Contains("a parameter has the name of a symbol of "));
  folder.write("two.cpp", R"(#include "core/numerics/formulas/energy_formula.h"
DRAPE_FOLD(one, "One.") { return k * square(theta); }
DRAPE_FOLD(other, "Another.") { return k * square(bend); }
)");
  CHECK_THAT(folder.refused(listed + "two.cpp"), Contains("drape_plugin_macro_needs_a_file_of_its_own"));
}

TEST_CASE("An empty part of a list of folders stands for no folder: the user's has no programs or headers") {
  const PluginFolder folder;
  folder.write("vector", "#error taken\n");
  folder.write("as", "#!/bin/sh\nexit 1\n");
  fs::permissions(folder / "as", fs::perms::owner_all);
  const std::string cache = "XDG_CACHE_HOME=" + (folder / "cache").string();
  const Ended ended = drape_with(listed + "rubber.cpp", folder.path,
                                 cache + " CPLUS_INCLUDE_PATH=/nowhere: COMPILER_PATH=:/nowhere PATH=:$PATH");
  INFO(ended.err);
  CHECK(ended.exit_code == 0);
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
  CHECK_THAT(refusal("check-energy nothing"), Contains("error: bind returned null; "));
  CHECK(refusal("check-energy throws") == "error: " + other);
  CHECK(refusal("check-energy refuses") == "error: energy: refuses: " + other);
  CHECK_THAT(refusal("check drape.yaml --set energies=[throws]"), EndsWith(other));
}

TEST_CASE("What is no plugin's source, or cannot be compiled, is refused") {
  const PluginFolder folder;
  const std::string good = (folders::test_plugins() / "good").string(), library = good + "/libgood.so";
  check_error(folder.refused(listed + library),
              "--plugin " + library +
                  ": is compiled, and --plugin takes a source; put the folder of the library into "
                  "DRAPE_PLUGIN_PATH instead, as in export DRAPE_PLUGIN_PATH=" +
                  good + "\n");
  folder.write("text.so", "no C++\n");  // a source may have any name
  CHECK_THAT(folder.refused(listed + "text.so"), Contains("text.so:1:") && Contains("does not compile"));
  folder.write("empty.cpp", "int main() {}\n");
  CHECK_THAT(folder.refused(listed + "empty.cpp"), Contains("is not a drape plugin"));
  CHECK_THAT(folder.refused(listed + "none.cpp"), Contains("none.cpp") && Contains("No such file"));
  CHECK_THAT(
      folder.refused(listed + "rubber.cpp", "CXX=/nowhere/c++"),
      Contains("--plugin: there is no compiler /nowhere/c++; install it (Debian's package g++), or name "));
  check_error(folder.refused(listed + "rubber.cpp", "TMPDIR=/nonexistent"),
              "--plugin: the folder for temporary files, TMPDIR=/nonexistent, is not there (");
  CHECK_THAT(folder.refused(listed + "rubber.cpp", "XDG_CACHE_HOME=/proc/none"),
             Contains("error: --plugin: cannot make /proc/none/drape/rubber-") &&
                 EndsWith("for the library (No such file or directory); name a folder for it in the variable "
                          "XDG_CACHE_HOME\n"));
}

TEST_CASE("A library is kept where only this user can write, and loaded from nowhere else") {
  const PluginFolder folder;
  const fs::path temporary = folder / "tmp", cache = temporary / ("drape-cache-" + std::to_string(geteuid()));
  fs::create_directory(temporary);
  const std::string homeless = "HOME= XDG_CACHE_HOME= TMPDIR=" + temporary.string(),
                    command = listed + "rubber.cpp";
  const auto refusal = [&] { return refused_by(command, folder.path, homeless); };
  CHECK_THAT(drape_with(command, folder.path, homeless).out, Contains("rubber"));
  CHECK(fs::is_directory(cache));
  const fs::path library = *fs::directory_iterator(cache);
  for (const fs::path& own : {cache, library}) {
    fs::permissions(own, fs::perms::all);
    CHECK_THAT(drape_with(command, folder.path, homeless).err, Contains("compiling"));
    CHECK((fs::status(own).permissions() & (fs::perms::group_write | fs::perms::others_write)) ==
          fs::perms::none);
    fs::rename(own, folder / "elsewhere");
    fs::create_directory_symlink(folder / "elsewhere", own);
    CHECK_THAT(refusal(), Contains("another user may have put a library into " + own.string()) &&
                              Contains("name a folder for it in the variable XDG_CACHE_HOME"));
    fs::remove(own);
    fs::rename(folder / "elsewhere", own);
    if (geteuid() != 0) continue;  // only root can give folders away
    REQUIRE(lchown(own.c_str(), 1, 1) == 0);
    CHECK_THAT(refusal(), Contains("another user may have put a library into " + own.string()));
    REQUIRE(lchown(own.c_str(), 0, 0) == 0);
  }
  CHECK_THAT(drape_with(command, folder.path, homeless).err, !Contains("compiling"));
}

TEST_CASE("What others may have put into the cache while they could write to it is not loaded") {
  const PluginFolder folder;
  const std::string command = listed + "rubber.cpp";
  REQUIRE_THAT(folder.with(command).err, Contains("compiling"));
  fs::path library;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "cache/drape"))
    if (entry.path().extension() == ".so") library = entry.path();
  const fs::path own = library.parent_path();
  CHECK_THAT(folder.with(command).err, !Contains("compiling"));
  fs::permissions(own, fs::perms::all);
  CHECK_THAT(folder.with(command).err, Contains("compiling"));
  CHECK((fs::status(own).permissions() & fs::perms::others_write) == fs::perms::none);
  fs::permissions(library, fs::perms::all);
  CHECK_THAT(folder.with(command).err, Contains("compiling"));
}

TEST_CASE("A relative folder for the cache is not used: it would be another one wherever the command runs") {
  const PluginFolder folder;
  const std::string temporary = (folder / "tmp").string();
  fs::create_directory(temporary);
  for (const std::string relative : {"HOME=. XDG_CACHE_HOME=cache", "HOME=./home XDG_CACHE_HOME="})
    CHECK_THAT(drape_with(listed + "rubber.cpp", folder.path, relative + " TMPDIR=" + temporary).out,
               Contains("  rubber "));
  for (const char* name : {"cache", "home", ".cache", "drape"}) CHECK_FALSE(fs::exists(folder / name));
  CHECK_FALSE(fs::is_empty(temporary));
}

TEST_CASE("A plugin that ends the program is an error, with whatever code it does so") {
  const PluginFolder folder;
  folder.write("ends.cpp", "#include <cstdlib>\n" + energy_file + "const int code = (std::exit(0), 0);\n");
  const Ended ended = folder.with("check drape.yaml --plugin ends.cpp");
  CHECK(ended.exit_code == 3);
  CHECK_THAT(ended.err, EndsWith("error: a plugin ended the program\n"));
}

TEST_CASE("A colon in the name of a plugin's source does no harm, and in the cache's it is refused") {
  const PluginFolder folder;
  fs::create_directory(folder / "a:b");
  fs::rename(folder / "rubber.cpp", folder / "a:b/rub:ber.cpp");
  fs::copy_file(folder / "stiffness.h", folder / "a:b/stiffness.h");
  const std::string command = listed + "a:b/rub:ber.cpp";
  CHECK_THAT(folder.with(command).out, Contains("  rubber "));
  const std::string cache = (folder / "a:b").string();
  CHECK_THAT(folder.refused(command, "XDG_CACHE_HOME=" + cache),
             Contains("separates the folders of DRAPE_PLUGIN_PATH, so that it cannot name " + cache));
}
