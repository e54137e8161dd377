// Every experiment of the project is sound, and runs: here on a few vertices and two levels.

#include <algorithm>
#include <catch2/catch.hpp>

#include "core/app/files/yaml_file.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"

namespace fs = std::filesystem;

namespace {

const fs::path root_folder = folders::source();

/// Obstacles that `make data` makes are not part of the project.
bool needs_missing_data(const fs::path& config) {
  return text_of(config).find("../data/") != std::string::npos && !fs::exists(root_folder / "data/bunny.ply");
}

/// The project's experiments, or its sweeps, that miss no data.
std::vector<fs::path> shipped(bool sweeps) {
  std::vector<fs::path> files;
  for (const char* folder : {"configs", "benchmarks"})
    for (const auto& entry : fs::recursive_directory_iterator(root_folder / folder)) {
      const fs::path& file = entry.path();
      const bool is_yaml = file.extension() == ".yaml" || file.extension() == ".yml";
      const bool is_sweep = file.parent_path().filename() == "sweeps";
      if (is_yaml && is_sweep == sweeps && !needs_missing_data(file)) files.push_back(file);
    }
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() >= 3);
  return files;
}

/// Makes the cloth small, whatever its shape; of those with 10 or 12 rows one in fifteen slides off the
/// armadillo.
std::string shrunk(const fs::path& config) {
  drape::ConfigErrors errors;
  const drape::ConfigNode root = drape::read_yaml(config, errors);
  REQUIRE(errors.empty());
  const drape::ConfigNode* cloth = root.find("cloth");
  const drape::ConfigNode* shape = cloth ? cloth->find("shape") : nullptr;
  const bool from_file = shape && shape->scalar == "file";
  const std::string tolerance = " --set newton.force_tolerance=1e-2";
  if (from_file) return tolerance + " --set levels=1";
  return tolerance + " --set levels=2 --set cloth.columns=0 --set cloth.rows=0 --set cloth.vertices=256";
}

}  // namespace

TEST_CASE("every shipped experiment passes drape check as it is") {
  const Scratch folder;
  for (const fs::path& config : shipped(false)) {
    INFO(config);
    shown_by("check " + config.string(), folder.path);
  }
}

// By one method: `drape check` reads the others' settings, and other tests solve by every method.
TEST_CASE("every shipped experiment converges, made small") {
  for (const fs::path& config : shipped(false)) {
    INFO(config);
    const Scratch folder;
    shown_by("run " + config.string() + " --out out --threads 1 --quiet --no-report" + shrunk(config),
             folder.path);
    CHECK(fs::exists(folder / "out/results.json"));
  }
}

TEST_CASE("every shipped sweep passes drape sweep --dry-run") {
  for (const fs::path& config : shipped(true)) {
    INFO(config);
    const Scratch folder;
    const Ended ended = drape_with("sweep " + config.string() + " --dry-run", folder.path);
    if (ended.err.find("../data/") == std::string::npos) CHECK((ended.err == "" && ended.exit_code == 0));
  }
}
