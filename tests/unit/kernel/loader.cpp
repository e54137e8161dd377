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
#include "tests/unit/kernel/config_faults.h"

using namespace drape;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const fs::path plugins = folders::test_plugins();

fs::path test_library(const std::string& name) { return plugins / name / ("lib" + name + ".so"); }

/// What loading a folder says whose one plugin is this file.
std::string error_of_bytes(const std::string& bytes) {
  const Scratch folder;
  folder.write("some.so", bytes);
  Registry registry;
  const std::string message = refusal_of([&] { load_plugins(registry, {folder.path}); });
  return message.empty() ? "" : replaced(message, (folder / "some.so").string() + ": cannot be loaded: ", "");
}

}  // namespace

TEST_CASE("whoever changes a class that plugins see is told of the ABI number") {
  // If a size differs: raise DRAPE_ABI_NUMBER unless that was done since the last release, then write the new
  // number and the new size here.
  CHECK(DRAPE_ABI_NUMBER == 3);
  CHECK(sizeof(ConfigNode) == 200);
  CHECK(sizeof(Parameter) == 400);
  CHECK(sizeof(TriangleMesh) == 144);
  CHECK(sizeof(Topology) == 168);
  CHECK(sizeof(Level) == 608);
  CHECK(sizeof(Material) == 144);
  CHECK(sizeof(BlockMatrix) == 40);
  CHECK(sizeof(NewtonParameters) == 64);
}

TEST_CASE("a plugin's entry is registered and made, once from a folder named twice, and by each registry") {
  Registry first, second;
  load_plugins(first, {plugins / "good", plugins / "good" / ".." / "good"});
  load_plugins(second, {plugins / "good"});
  for (const Registry* registry : {&first, &second}) {
    REQUIRE(registry->entries().size() == 1);
    const RegistryEntry* entry = registry->find("refiner", "good");
    REQUIRE(entry);
    CHECK(entry->library == test_library("good").string());
    CHECK(entry->summary == "A refiner that loads.");
    ConfigErrors errors;
    const auto refiner = make_from<Refiner>(*registry, node_of_yaml("{type: good, rows: 7}"), errors);
    REQUIRE(refiner);
    CHECK(refiner->weights({}).rows() == 7);
  }
}

TEST_CASE("a repeated name is refused with both libraries") {
  Registry registry;
  REQUIRE_THROWS_WITH(load_plugins(registry, {plugins / "good", plugins / "duplicate"}),
                      "refiner \"good\" of " + test_library("duplicate").string() +
                          " is already registered by " + test_library("good").string() +
                          "; rename it or take one of them out of the search path");
  CHECK(registry.entries().size() == 1);
}

TEST_CASE("mismatch names what differs, on both sides, of a build in detail") {
  constexpr DrapePluginDescriptor ours = DRAPE_ABI_DESCRIPTOR(nullptr);
  CHECK(mismatch(ours) == "");
  DrapePluginDescriptor theirs = ours;
  theirs.magic = 1;
  CHECK(mismatch(theirs) == "its descriptor is not one of drape");
  theirs = ours;
  theirs.abi_number = 999;
  theirs.build = nullptr;  // another ABI number: nothing else may be read
  CHECK(mismatch(theirs) == "its ABI number is 999, drape's is " + std::to_string(ours.abi_number));
  for (const std::string& part :
       {" aligned to " + std::to_string(EIGEN_MAX_ALIGN_BYTES) + " bytes",
        "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + ".", std::string("libstdc++ ")})
    CHECK_THAT(std::string(ours.build), Contains(part));
}

TEST_CASE("a library that is no plugin of this drape, or a faulty one, is refused with its path") {
  const std::string no_plugin = "is not a drape plugin: ",
                    see = " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)",
                    other = "does not fit this drape, rebuild it: it was built by ",
                    own = "; drape by " DRAPE_BUILD;
  const auto check = [](const std::string& name, const std::string& refusal) {
    Registry registry;
    CHECK(refusal_of([&] { load_plugins(registry, {plugins / name}); }) ==
          test_library(name).string() + ": " + refusal);
    CHECK(registry.entries().empty());
  };
  check("not_a_plugin", no_plugin + "it exports no function drape_plugin" + see);
  check("null_descriptor", no_plugin + "its function drape_plugin returns null" + see);
  check("null_entries", no_plugin + "its descriptor has no function that names its entries" + see);
  check("wrong_abi", other + "GCC 4.8, Eigen 3.3.9" + own);
  check("null_names", other + "what it does not tell" + own);
  check("no_entries", "names no entries; add some in its DRAPE_PLUGIN");
  check("no_name", "registers a refiner without a name; give it one");
  check("throwing", "its DRAPE_PLUGIN throws: out of luck");
  check("static_initialiser", "its static initialiser throws: out of luck");
}

TEST_CASE("a plugin cut short at any length is refused, and ends no process") {
  const std::string whole = read_file(test_library("good"));
  REQUIRE(whole.size() > 4096);
  CHECK(error_of_bytes(whole) == "");
  CHECK(error_of_bytes(whole.substr(0, whole.size() - 1)) ==
        "the file is cut short at " + std::to_string(whole.size() - 1) +
            " bytes, its headers ask for more; build or copy it again");
  std::vector<std::size_t> lengths;
  for (std::size_t k = 0; k < 1024; k += 61) lengths.push_back(k);
  for (std::size_t k = 1024; k < whole.size(); k += whole.size() / 150) lengths.push_back(k);
  for (const std::size_t length : lengths) {
    CAPTURE(length);
    REQUIRE_THAT(error_of_bytes(whole.substr(0, length)), Contains("cut short"));
  }
}

TEST_CASE("a library of another machine or kind, or none is refused") {
  const auto with = [&](std::size_t at, int value) {
    std::string bytes = read_file(test_library("good"));
    bytes[at] = static_cast<char>(bytes[at] ^ value);
    return error_of_bytes(bytes);
  };
  CHECK(with(EI_CLASS, 3) != "");
  CHECK(with(EI_DATA, 3) != "");
  CHECK(with(offsetof(ElfW(Ehdr), e_machine), 0x55) != "");
  CHECK(with(offsetof(ElfW(Ehdr), e_type), ET_DYN ^ ET_EXEC) != "");
  CHECK_THAT(with(offsetof(ElfW(Ehdr), e_shoff) + 3, 0x7f), Contains("cut short"));
  for (const std::string& text : {"#!/bin/sh\n" + std::string(100, ' '), std::string("a text\n")})
    CHECK_THAT(error_of_bytes(text), Contains("it is no shared library"));

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
  const Scratch folder("not a library");
  load_plugins(registry, {folder.path});
  CHECK(registry.entries().empty());
  CHECK_THROWS_WITH(load_plugins(registry, {folder / "none"}),
                    (folder / "none").string() + ": is not a folder of plugins");
}

TEST_CASE("DRAPE_PLUGIN_PATH lists folders beside that of the shipped plugins") {
  const auto directories_with = [](const std::string& path) {
    setenv("DRAPE_PLUGIN_PATH", path.c_str(), 1);
    const auto directories = plugin_directories();
    unsetenv("DRAPE_PLUGIN_PATH");
    REQUIRE(!directories.empty());
    CHECK(fs::equivalent(directories[0], folders::plugins()));
    return std::vector<fs::path>(directories.begin() + 1, directories.end());
  };
  const fs::path good = plugins / "good", duplicate = plugins / "duplicate";
  CHECK(directories_with("").empty());
  CHECK((directories_with(good.string() + "::" + duplicate.string()) == std::vector{good, duplicate}));
}
