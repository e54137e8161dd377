// Words of the project's former private language, and the field's words that replaced them, in one list.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/folders.h"

namespace fs = std::filesystem;

namespace {

struct Renamed {
  const char *before, *now;
};

/// Identifiers, in sources, scripts and documents.
constexpr Renamed identifiers[] = {
    // contact
    {"bent_advance", "nonlinear_ccd"},
    {"Slab", "SeparatingPlane"},
    {"gap_left_by_moves", "the minimum-gap policy"},
    {"ObstacleWay", "ObstacleTrajectory"},
    {"SolidWay", "SolidTrajectory"},
    {"MeanMoves", "AveragedContactDisplacement"},
    {"SoundMesh", "ValidatedMesh"},
    {"ContactSweep", "CollisionCandidates"},
    {"ContactSet", "Collisions"},
    {"Touch", "Intersection"},
    {"Slip", "TangentialDisplacement"},
    {"add_slips", "tangential_displacements"},
    {"add_slips_carried", "tangential_displacements"},
    {"MovableObstacles", "KinematicObstacles"},
    {"models_changed", "update_obstacles"},
    {"renew_lag", "update_lagging"},
    {"leave_out_friction", "disable_friction"},
    {"slip_distance", "friction_smoothing_distance"},
    // Newton, load stepping, constraints
    {"refined_early", "refined_early_on_request"},
    {"out_of_steps", "max_steps_reached"},
    {"afresh", "from_initial_state"},
    {"projection_share", "psd_blend"},
    {"strained_for", "a stall counter"},
    {"held_up", "blocked"},
    {"follow_change", "the extrapolation predictor"},
    {"ChangeResponse", "IncrementResponse"},
    {"begun_at", "initial centroid"},
    {"HardPositions", "DirichletEnforcer"},
    {"HeldVertex", "DirichletVertex"},
    {"let_go", "release"},
    {"given_up", "infeasible"},
    {"farthest_missing", "max_constraint_violation"},
    {"brings_held_vertices", "enforces_dirichlet"},
    {"carry_up", "prolong"},
    {"CarryUp", "Prolongation"},
    {"PullToTarget", "TargetObjective"},
    {"SumMatrix", "HessianAssembler"},
    {"forget_room", "invalidate"},
    // experiment, command, results
    {"PlaceParameters", "VertexSelection"},
    {"check_places", "check_boundary_conditions"},
    {"held_vertices", "dirichlet_vertices"},
    {"obstacles_way", "obstacle_step_limit"},
    {"flow_on", "warm_start"},
    {"begun_from", "warm_started_from"},
    {"tighten", "solve_to_tolerance"},
    {"FileMark", "FileFingerprint"},
    {"marks_of_files", "fingerprints_of_files"},
    {"Session", "CheckpointManager"},
    {"error_works", "error_costs"},
    {"RunSet", "RunCollection"},
    {"SetRun", "RunRecord"},
    {"Looked", "Audit"},
    {"RunBrokenOff", "RunAborted"},
    {"broken_off", "aborted"},
    {"or_word", "shorthand"},
    {"word_key", "shorthand_key"},
};

/// Keys of experiments.
constexpr Renamed keys[] = {
    {"range", "dhat"},
    {"slip_distance", "friction_smoothing_distance"},
    {"keep", "min_gap_fraction"},
    {"refresh", "hessian_update_interval"},
    {"projection_share", "psd_blend"},
    {"move", "translate"},
    {"turn", "rotate"},
    {"about", "centre"},
    {"at", "times"},
    {"to", "values"},
    {"between", "interpolation"},
    {"settle", "equilibrate"},
    {"frames", "snapshots"},
    {"verify", "check_intersections"},
};

/// Files below the folders with one of these endings, without generated and stored ones.
std::vector<fs::path> files_of(const std::vector<std::string>& folders,
                               const std::vector<std::string>& endings) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(folders::source()) / folder)) {
      const fs::path& path = entry.path();
      const bool wanted = std::find(endings.begin(), endings.end(), path.extension()) != endings.end();
      const bool stored = path.string().find("/benchmarks/results/") != std::string::npos;
      if (entry.is_regular_file() && wanted && !stored && path.filename() != "vocabulary.cpp")
        files.push_back(path);
    }
  return files;
}

/// The position of a whole word in a line, or npos.
std::size_t find_word(const std::string& line, const std::string& word) {
  const auto part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (std::size_t at = line.find(word); at != line.npos; at = line.find(word, at + 1))
    if ((at == 0 || !part(line[at - 1])) &&
        (at + word.size() == line.size() || !part(line[at + word.size()])))
      return at;
  return line.npos;
}

/// A word that English does not have: snake_case, or with a capital inside.
bool is_distinctive(const std::string& word) {
  return word.find('_') != word.npos ||
         std::any_of(word.begin() + 1, word.end(), [](unsigned char c) { return std::isupper(c); });
}

/// Calls `use(line, "file:line")` for every line except those that refuse a former name.
template <class Use>
void for_each_line(const fs::path& file, const Use& use) {
  std::ifstream in(file);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find("formerly(") != line.npos || line.find("is now called") != line.npos) continue;
    use(line, file.string() + ":" + std::to_string(number));
  }
}

}  // namespace

TEST_CASE("the sources use the field's words") {
  std::vector<fs::path> files = files_of({"core", "plugins", "tests", "benchmarks", "docs", "configs"},
                                         {".cpp", ".h", ".js", ".mjs", ".html", ".py", ".md", ".yaml"});
  files.push_back(fs::path(folders::source()) / "README.md");
  CHECK(files.size() > 400);
  for (const fs::path& file : files)
    for_each_line(file, [&](const std::string& line, const std::string& where) {
      const std::string code = line.substr(0, line.find("//"));
      for (const Renamed& word : identifiers) {
        const bool distinctive = is_distinctive(word.before);
        if (!distinctive && file.extension() != ".cpp" && file.extension() != ".h") continue;
        if (find_word(distinctive ? line : code, word.before) != line.npos)
          FAIL_CHECK(where << ": \"" << word.before << "\" is now called \"" << word.now << "\"");
      }
    });
}

TEST_CASE("configs use the present keys") {
  const std::vector<fs::path> files = files_of({"configs", "tests", "benchmarks"}, {".yaml"});
  CHECK(files.size() > 40);
  std::vector<std::regex> written;
  for (const Renamed& key : keys) written.emplace_back("(^|[{,.]) *(- )?" + std::string(key.before) + ": ");
  for (const fs::path& file : files)
    for_each_line(file, [&](const std::string& line, const std::string& where) {
      const std::string text = line.substr(0, line.find('#'));
      for (std::size_t k = 0; k < written.size(); ++k)
        if (std::regex_search(text, written[k]))
          FAIL_CHECK(where << ": key \"" << keys[k].before << "\" is now called \"" << keys[k].now << "\"");
    });
}
