// The same experiment gives the same results, bit for bit.

#include <catch2/catch.hpp>
#include <map>

#include "core/mesh/io.h"
#include "tests/support/command.h"

namespace {

/// The bytes of every level's mesh, by name.
std::map<std::string, std::string> meshes_with(int threads) {
  const Scratch folder;
  folder.write("e.yaml", small_experiment());
  // Some steps on many elements, so that loops are shared out.
  const Ended ended = drape_with(
      "run e.yaml --out out --quiet --no-report --set cloth.columns=24 --set cloth.rows=24 "
      "--set newton.max_steps=5 --threads " +
          std::to_string(threads),
      folder.path);
  REQUIRE(ended.exit_code == 1);
  std::map<std::string, std::string> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out/levels"))
    if (entry.path().extension() == ".ply") meshes[entry.path().filename()] = text_of(entry.path());
  REQUIRE(meshes.size() == 6);
  return meshes;
}

}  // namespace

TEST_CASE("runs are equal bit for bit, with one thread, with two, and with one and two") {
  const auto one = meshes_with(1), two = meshes_with(2);
  CHECK((meshes_with(1) == one));
  CHECK((meshes_with(2) == two));
  CHECK((one == two));
}
