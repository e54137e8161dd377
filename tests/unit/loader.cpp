#include "core/plugin/loader.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "core/model/refiner.h"
#include "core/plugin/abi.h"
#include "core/plugin/make.h"

using namespace drape;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const fs::path plugins = DRAPE_TEST_PLUGIN_DIR;

fs::path library(const std::string& name) { return plugins / name / ("lib" + name + ".so"); }

/// DRAPE_PLUGIN_PATH for the life of the object.
class PluginPath {
 public:
  explicit PluginPath(const std::string& value) { setenv("DRAPE_PLUGIN_PATH", value.c_str(), 1); }
  ~PluginPath() { unsetenv("DRAPE_PLUGIN_PATH"); }
};

/// An empty folder that goes away with the object.
struct TemporaryFolder {
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "drape_loader_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()));
    path = name;
  }
  ~TemporaryFolder() { fs::remove_all(path); }
  fs::path path;
};

constexpr DrapePluginDescriptor ours = DRAPE_ABI_DESCRIPTOR(nullptr);

}  // namespace

TEST_CASE("a plugin's entries are registered, made and destroyed") {
  Registry registry;
  load_plugins(registry, {plugins / "good"});
  REQUIRE(registry.entries().size() == 1);
  const RegistryEntry* entry = registry.find("refiner", "good");
  REQUIRE(entry);
  CHECK(entry->library == library("good").string());
  CHECK(entry->summary == "A refiner that loads.");

  ConfigErrors errors;
  ConfigNode node;
  node.add("type", ConfigNode::of("good"));
  node.add("rows", ConfigNode::of(7));
  const std::shared_ptr<Refiner> refiner = make_from<Refiner>(registry, node, errors);
  REQUIRE(errors.empty());
  REQUIRE(refiner);
  CHECK(refiner->refine(Level()).weights.rows() == 7);
}

TEST_CASE("a folder named twice is loaded once, and another registry may load it again") {
  Registry first, second;
  load_plugins(first, {plugins / "good", plugins / "good" / ".." / "good"});
  load_plugins(second, {plugins / "good"});
  CHECK(first.entries().size() == 1);
  CHECK(second.entries().size() == 1);
}

TEST_CASE("a repeated name is refused with both libraries") {
  Registry registry;
  REQUIRE_THROWS_WITH(load_plugins(registry, {plugins / "good", plugins / "duplicate"}),
                      "refiner \"good\" of " + library("duplicate").string() + " is already registered by " +
                          library("good").string() +
                          "; rename it or take one of them out of the search path");
  CHECK(registry.entries().size() == 1);
}

TEST_CASE("a plugin of another build is refused before any of it runs") {
  Registry registry;
  REQUIRE_THROWS_WITH(load_plugins(registry, {plugins / "wrong_abi"}),
                      library("wrong_abi").string() +
                          ": does not fit this drape, rebuild it: "
                          "the compiler is GCC 4.8 in the plugin and " +
                          ours.compiler + " in drape; the Eigen version is 3.3.9 in the plugin and " +
                          ours.eigen_version + " in drape");
  CHECK(registry.entries().empty());
}

TEST_CASE("mismatch names what differs, on both sides") {
  CHECK(mismatch(ours) == "");
  DrapePluginDescriptor theirs = ours;
  theirs.magic = 1;
  CHECK(mismatch(theirs) == "its descriptor is not one of drape");
  theirs = ours;
  theirs.abi_number = 999;
  theirs.compiler = nullptr;  // another ABI number: nothing else may be looked at
  CHECK(mismatch(theirs) ==
        "the ABI number is 999 in the plugin and " + std::to_string(ours.abi_number) + " in drape");
  theirs = ours;
  theirs.eigen_max_align_bytes = 8;
  CHECK(mismatch(theirs) == "Eigen's alignment (-march) is 8 bytes in the plugin and " +
                                std::to_string(ours.eigen_max_align_bytes) + " bytes in drape");
  theirs = ours;
  theirs.scalar = "float";
  CHECK(mismatch(theirs) == "the scalar type is float in the plugin and double in drape");
}

TEST_CASE("a library that is no plugin, or no library, is refused with its path") {
  Registry registry;
  CHECK_THROWS_WITH(load_plugins(registry, {plugins / "not_a_plugin"}),
                    library("not_a_plugin").string() +
                        ": is not a drape plugin: it exports no function drape_plugin"
                        " (see DRAPE_PLUGIN in core/plugin/plugin.h)");
  const TemporaryFolder folder;
  const fs::path file = folder.path / "broken.so";
  REQUIRE(std::fclose(std::fopen(file.c_str(), "w")) == 0);
  CHECK_THROWS_WITH(load_plugins(registry, {folder.path}), Contains(file.string() + ": cannot be loaded: "));
  CHECK(registry.entries().empty());
}

TEST_CASE("only *.so files are loaded, and a missing folder is refused") {
  Registry registry;
  const TemporaryFolder folder;
  REQUIRE(std::fclose(std::fopen((folder.path / "README.md").c_str(), "w")) == 0);
  load_plugins(registry, {folder.path});
  CHECK(registry.entries().empty());
  CHECK_THROWS_WITH(load_plugins(registry, {folder.path / "none"}),
                    (folder.path / "none").string() + ": is not a folder of plugins");
}

TEST_CASE("DRAPE_PLUGIN_PATH lists folders, which must exist") {
  size_t beside;
  {
    const PluginPath none("");
    beside = plugin_directories().size();
  }
  {
    const PluginPath path((plugins / "good").string() + "::" + (plugins / "duplicate").string());
    const auto directories = plugin_directories();
    REQUIRE(directories.size() == beside + 2);
    CHECK(directories[beside] == plugins / "good");
    CHECK(directories[beside + 1] == plugins / "duplicate");
  }
  const PluginPath path("/nowhere/at/all");
  CHECK_THROWS_WITH(plugin_directories(), "DRAPE_PLUGIN_PATH names /nowhere/at/all, which is not a folder");
}
