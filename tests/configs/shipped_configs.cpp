// Every experiment of the project is sound, and runs, here on a few vertices and two levels, to what it ran
// to when a vertex had one rest position in space.

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>

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

/// Whether this is the build of former_runs.json. Others round differently, and cloth that buckles ends in
/// other folds.
#if defined __GNUC__ && !defined __clang__ && defined __znver3__ && defined __AVX512F__ && defined NDEBUG
constexpr bool recorded_build = __GNUC__ == 12 && !DRAPE_SANITIZED;
#else
constexpr bool recorded_build = false;
#endif

const fs::path former_runs = folders::source() / "tests/configs/data/former_runs.json";

/// A row of former_runs.json: the start's energy, and of each level the iterations, the energy and the
/// checksum of the mesh.
nlohmann::json row_of(const fs::path& run) {
  std::ifstream iterations(run / "iterations.csv");
  std::string word;
  std::getline(iterations, word);
  const auto at = std::count(word.begin(), word.begin() + static_cast<long>(word.find(",energy,")), ',') + 1;
  for (int k = 0; k <= at; ++k) std::getline(iterations, word, ',');
  auto levels = nlohmann::json::array();
  const auto methods = results_in(run)["methods"];
  for (const auto& level : methods.front()["levels"])
    levels.push_back({level["iterations"], level["energy"], level["mesh_checksum"]});
  return {{"start", std::stod(word)}, {"levels", levels}};
}

/// Compares a run with its row. `make golden` writes the rows, whose change git shows; a change of results
/// says why in its commit.
void check_former(const nlohmann::json& former, const nlohmann::json& now) {
  CHECK(now["start"].get<double>() == Approx(former["start"].get<double>()).epsilon(1e-12));
  INFO("as it runs now: " << now);
  if (recorded_build) CHECK((now["levels"] == former["levels"]));
}

void write_rows(const nlohmann::json& rows) {
  std::ofstream file(former_runs);
  std::string before = "{\n  ";
  for (const auto& [config, row] : rows.items()) {
    const std::string levels = std::regex_replace(row["levels"].dump(), std::regex(","), ", ");
    file << before << '"' << config << "\": {\"start\": " << row["start"] << ", \"levels\": " << levels
         << "}";
    before = ",\n  ";
  }
  file << "\n}\n";
}

}  // namespace

// By one method: `drape check` reads the others' settings, and other tests solve by every method.
TEST_CASE("every shipped experiment passes drape check as it is, and converges, made small") {
  auto former = json_in(former_runs);
  const bool writes = std::getenv("DRAPE_GOLDEN") != nullptr;
  std::size_t compared = 0;
  for (const fs::path& config : shipped(false)) {
    INFO(config);
    const Scratch folder;
    shown_by("check " + config.string(), folder.path);
    shown_by(
        "run " + config.string() + " --out out --threads 1 --quiet --no-report --measure" + shrunk(config),
        folder.path);
    CHECK(fs::exists(folder / "out/results.json"));
    const auto row = former.find(config.lexically_relative(folders::source()).string());
    if (row == former.end()) continue;
    const nlohmann::json now = row_of(folder / "out");
    if (writes)
      *row = now;
    else
      check_former(*row, now);
    ++compared;
  }
  if (writes) write_rows(former);
  CHECK(compared == former.size());
}

TEST_CASE("every shipped sweep passes drape sweep --dry-run") {
  for (const fs::path& config : shipped(true)) {
    INFO(config);
    const Scratch folder;
    const Ended ended = drape_with("sweep " + config.string() + " --dry-run --allow-memory", folder.path);
    if (ended.err.find("../data/") == std::string::npos) CHECK((ended.err == "" && ended.exit_code == 0));
  }
}
