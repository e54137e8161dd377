// Every experiment of the project is sound, and runs: here on a few vertices and two levels.

#include <algorithm>

#include "tests/configs/runs.h"

namespace {

/// Obstacles that `make data` makes are not part of the project.
bool needs_missing_data(const fs::path& config) {
  return text_of(config).find("../data/") != std::string::npos &&
         !fs::exists(folders::source() / "data/bunny.ply");
}

/// The project's experiments, or its sweeps, that miss no data.
std::vector<fs::path> shipped(bool sweeps) {
  std::vector<fs::path> files;
  for (const char* folder : {"configs", "benchmarks"})
    for (const auto& entry : fs::recursive_directory_iterator(folders::source() / folder)) {
      const fs::path& file = entry.path();
      const bool is_sweep = file.parent_path().filename() == "sweeps";
      const bool is_pattern = file.parent_path().filename() == "garments";
      if (file.extension() == ".yaml" && is_sweep == sweeps && !is_pattern && !needs_missing_data(file))
        files.push_back(file);
    }
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() >= 3);
  return files;
}

/// Makes the cloth small; of those with 10 or 12 rows one in fifteen slides off the armadillo.
std::string shrunk(const fs::path& config) {
  const bool from_file = text_of(config).find("shape: file") != std::string::npos;
  return " --set newton.force_tolerance=1e-2 --set levels=" +
         (from_file ? std::string("1")
                    : "2 --set cloth.columns=0 --set cloth.rows=0 --set cloth.vertices=256");
}

}  // namespace

// By one method: `drape check` reads the others' settings, and other tests solve by every method.
TEST_CASE("every shipped experiment passes drape check as it is, and converges, made small") {
  for (const fs::path& config : shipped(false)) {
    INFO(config);
    const Scratch folder;
    shown_by("check " + config.string(), folder.path);
    shown_by(
        "run " + config.string() + " --out out --threads 1 --quiet --no-report --measure" + shrunk(config),
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
