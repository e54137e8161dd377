#include "core/kernel/plugin/loader.h"

#include <elf.h>
#include <link.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdlib>
#include <filesystem>

#include "core/kernel/files/file.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/abi.h"
#include "core/kernel/plugin/make.h"
#include "core/numerics/linear_algebra/block_matrix.h"
#include "core/numerics/step/newton_parameters.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"
#include "tests/support/refusal.h"

using namespace drape;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const fs::path plugins = folders::test_plugins();

fs::path test_library(const std::string& name) { return plugins / name / ("lib" + name + ".so"); }

/// DRAPE_PLUGIN_PATH for the life of the object.
class PluginPath {
 public:
  explicit PluginPath(const std::string& value) { setenv("DRAPE_PLUGIN_PATH", value.c_str(), 1); }
  ~PluginPath() { unsetenv("DRAPE_PLUGIN_PATH"); }
};

constexpr DrapePluginDescriptor ours = DRAPE_ABI_DESCRIPTOR(nullptr);

}  // namespace

TEST_CASE("whoever changes a class that plugins see is told of the ABI number") {
  // If a size differs: raise DRAPE_ABI_NUMBER unless that was done since the last release, then write the new
  // number and the new size here.
  CHECK(DRAPE_ABI_NUMBER == 1);
  CHECK(sizeof(ConfigNode) == 192);
  CHECK(sizeof(Parameter) == 560);
  CHECK(sizeof(TriangleMesh) == 64);
  CHECK(sizeof(Topology) == 168);
  CHECK(sizeof(Level) == 440);
  CHECK(sizeof(Material) == 144);
  CHECK(sizeof(BlockMatrix) == 40);
  CHECK(sizeof(NewtonParameters) == 64);
}

TEST_CASE("a plugin's entries are registered, made and destroyed") {
  Registry registry;
  load_plugins(registry, {plugins / "good"});
  REQUIRE(registry.entries().size() == 1);
  const RegistryEntry* entry = registry.find("refiner", "good");
  REQUIRE(entry);
  CHECK(entry->library == test_library("good").string());
  CHECK(entry->summary == "A refiner that loads.");

  ConfigErrors errors;
  ConfigNode node;
  node.add("type", ConfigNode::of("good"));
  node.add("rows", ConfigNode::of(7));
  const std::shared_ptr<Refiner> refiner = make_from<Refiner>(registry, node, errors);
  REQUIRE(errors.empty());
  REQUIRE(refiner);
  CHECK(refiner->weights(Level()).rows() == 7);
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
                      "refiner \"good\" of " + test_library("duplicate").string() +
                          " is already registered by " + test_library("good").string() +
                          "; rename it or take one of them out of the search path");
  CHECK(registry.entries().size() == 1);
}

TEST_CASE("a plugin of another build is refused before any of it runs") {
  Registry registry;
  REQUIRE_THROWS_WITH(load_plugins(registry, {plugins / "wrong_abi"}),
                      test_library("wrong_abi").string() +
                          ": does not fit this drape, rebuild it: it was built by GCC 4.8, Eigen 3.3.9; "
                          "drape by " DRAPE_BUILD);
  CHECK(registry.entries().empty());
}

TEST_CASE("mismatch names what differs, on both sides") {
  CHECK(mismatch(ours) == "");
  DrapePluginDescriptor theirs = ours;
  theirs.magic = 1;
  CHECK(mismatch(theirs) == "its descriptor is not one of drape");
  theirs = ours;
  theirs.abi_number = 999;
  theirs.build = nullptr;  // another ABI number: nothing else may be read
  CHECK(mismatch(theirs) == "its ABI number is 999, drape's is " + std::to_string(ours.abi_number));
  theirs = ours;
  theirs.build = "another compiler";
  CHECK(mismatch(theirs) == "it was built by another compiler; drape by " DRAPE_BUILD);
}

TEST_CASE("a build names the compiler, the standard library and Eigen's version and alignment") {
  const std::string build = ours.build;
  CHECK_THAT(build, Contains(" aligned to " + std::to_string(EIGEN_MAX_ALIGN_BYTES) + " bytes"));
  CHECK_THAT(build, Contains("Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "."));
  CHECK_THAT(build, Contains("libstdc++ "));
}

TEST_CASE("a library that is no plugin, or no library, is refused with its path") {
  Registry registry;
  CHECK_THROWS_WITH(load_plugins(registry, {plugins / "not_a_plugin"}),
                    test_library("not_a_plugin").string() +
                        ": is not a drape plugin: it exports no function drape_plugin"
                        " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)");
  const Scratch folder;
  const fs::path file = folder / "broken.so";
  folder.write("broken.so", "");
  CHECK_THROWS_WITH(load_plugins(registry, {folder.path}), Contains(file.string() + ": cannot be loaded: "));
  CHECK(registry.entries().empty());
}

TEST_CASE("a plugin that gives nothing where something is needed is refused with its path") {
  const auto error_of = [](const std::string& name) {
    Registry registry;
    const std::string error = refusal_of([&] { load_plugins(registry, {plugins / name}); });
    REQUIRE(registry.entries().empty());
    return error;
  };
  CHECK(error_of("null_descriptor") == test_library("null_descriptor").string() +
                                           ": is not a drape plugin: its function drape_plugin returns null"
                                           " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)");
  CHECK(error_of("null_names") == test_library("null_names").string() +
                                      ": does not fit this drape, rebuild it: it was built by what it does "
                                      "not tell; drape by " DRAPE_BUILD);
  CHECK(error_of("null_entries") ==
        test_library("null_entries").string() +
            ": is not a drape plugin: its descriptor has no function that names its entries"
            " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)");
  CHECK(error_of("no_entries") ==
        test_library("no_entries").string() + ": names no entries; add some in its DRAPE_PLUGIN");
  CHECK(error_of("no_name") ==
        test_library("no_name").string() + ": registers a refiner without a name; give it one");
  CHECK(error_of("throwing") == test_library("throwing").string() + ": its DRAPE_PLUGIN throws: out of luck");
}

namespace {

/// What loading a folder says whose one plugin is this file.
std::string error_of_bytes(const std::string& bytes) {
  const Scratch folder;
  folder.write("some.so", bytes);
  Registry registry;
  const std::string message = refusal_of([&] { load_plugins(registry, {folder.path}); }),
                    begin = (folder / "some.so").string() + ": cannot be loaded: ";
  return message.empty() ? "" : replaced(message, begin, "");
}

}  // namespace

TEST_CASE("a plugin cut short at any length is refused, and ends no process") {
  const std::string whole = read_file(test_library("good"));
  REQUIRE(whole.size() > 4096);
  CHECK(error_of_bytes(whole) == "");
  CHECK(error_of_bytes(whole.substr(0, whole.size() - 1)) ==
        "the file is cut short at " + std::to_string(whole.size() - 1) +
            " bytes, its headers tell of more; build or copy it again");
  std::vector<std::size_t> lengths;
  for (std::size_t k = 0; k < 1024; k += 61) lengths.push_back(k);
  for (std::size_t k = 1024; k < whole.size(); k += whole.size() / 150) lengths.push_back(k);
  for (const std::size_t length : lengths) {
    CAPTURE(length);
    REQUIRE_THAT(error_of_bytes(whole.substr(0, length)), Contains("cut short"));
  }
}

TEST_CASE("a library of another machine or kind, or none is refused") {
  const std::string whole = read_file(test_library("good"));
  const auto with = [&](std::size_t at, int value) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ value);
    return error_of_bytes(bytes);
  };
  CHECK(with(EI_CLASS, 3) != "");
  CHECK(with(EI_DATA, 3) != "");
  CHECK(with(offsetof(ElfW(Ehdr), e_machine), 0x55) != "");
  CHECK(with(offsetof(ElfW(Ehdr), e_type), ET_DYN ^ ET_EXEC) != "");
  CHECK_THAT(with(offsetof(ElfW(Ehdr), e_shoff) + 3, 0x7f), Contains("cut short"));
  CHECK_THAT(error_of_bytes("#!/bin/sh\n" + std::string(100, ' ')), Contains("it is no shared library"));
  CHECK_THAT(error_of_bytes("a text\n"), Contains("it is no shared library"));

  const Scratch folder;
  Registry registry;
  const fs::path odd = folder / "odd.so";
  const auto refused = [&](const std::string& why) {
    CHECK_THROWS_WITH(load_plugins(registry, {folder.path}), odd.string() + ": cannot be loaded: " + why);
    fs::remove(odd);
  };
  fs::create_directory(odd);
  refused("it is not a regular file; take it out of the folder");
  fs::create_symlink("nowhere", odd);
  refused("there is no such file; does the link lead nowhere?");
  REQUIRE(mkfifo(odd.c_str(), 0600) == 0);
  refused("it is not a regular file; take it out of the folder");
}

TEST_CASE("only *.so files are loaded, and a missing folder is refused") {
  Registry registry;
  const Scratch folder;
  folder.write("README.md", "");
  load_plugins(registry, {folder.path});
  CHECK(registry.entries().empty());
  CHECK_THROWS_WITH(load_plugins(registry, {folder / "none"}),
                    (folder / "none").string() + ": is not a folder of plugins");
}

TEST_CASE("DRAPE_PLUGIN_PATH lists folders, which must exist") {
  size_t beside;
  {
    const PluginPath none("");
    const auto found = plugin_directories();
    beside = found.size();
    REQUIRE(beside == 1);
    CHECK(fs::equivalent(found[0], folders::plugins()));
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
