// The same experiment gives the same results, bit for bit.

#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"
#include "tests/support/contact_scenes.h"

namespace {

/// The bytes of every level's mesh, by name, after some steps.
std::map<std::string, std::string> meshes_of(const Scratch& folder, const std::string& options, int threads) {
  drape_ends("run e.yaml --out out --method all --overwrite --quiet --no-report " + options + " --threads " +
                 std::to_string(threads),
             folder, 1);
  std::map<std::string, std::string> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out/levels"))
    if (entry.path().extension() == ".ply") meshes[entry.path().filename()] = text_of(entry.path());
  REQUIRE(meshes.size() == 6);
  return meshes;
}

/// The meshes with one thread; with two, and again with either, they must be the same.
std::map<std::string, std::string> repeated(const Scratch& folder, const std::string& options) {
  const auto one = meshes_of(folder, options, 1), two = meshes_of(folder, options, 2);
  CHECK((meshes_of(folder, options, 1) == one));
  CHECK((meshes_of(folder, options, 2) == two));
  CHECK((one == two));
  return one;
}

}  // namespace

// Both on many elements, so that loops are shared out.

TEST_CASE("runs are equal bit for bit, with one thread, with two, and with one and two") {
  const Scratch folder(small_experiment());
  repeated(folder, "--set cloth.columns=24 --set cloth.rows=24 --set newton.max_steps=5");
}

TEST_CASE("so are runs with obstacles, self-contact, friction and a strain limit") {
  const Scratch folder;
  write_sheets(folder, 20);
  const std::string options =
      "--set start.translate=[-0.2,-0.2,0.1035] --set newton.max_steps=6 --set contact.0.self_contact=";
  const auto one = repeated(folder, options + "true");
  for (const auto& [name, bytes] : meshes_of(folder, options + "false", 2)) {
    INFO(name);
    CHECK((bytes != one.at(name)));  // it does meet itself
  }
}

TEST_CASE("so are runs whose contact stiffness is raised") {
  const Scratch folder(drum("17", "1", "20", "newton"));
  const auto run_with = [&](int threads) {
    drape_ends("run e.yaml --out out --overwrite --quiet --no-report --threads " + std::to_string(threads),
               folder);
    const auto results = json_in(folder / "out/results.json");
    CHECK(results["methods"]["newton"]["levels"][0]["contact_stiffness"][1] > 10 * 9.81 * 20 * 3e-4 * 3.9);
    return text_of(folder / "out/levels/newton_l0.ply");
  };
  const std::string one = run_with(1);
  CHECK((run_with(2) == one));
}
