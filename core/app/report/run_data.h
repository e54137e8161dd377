#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/app/experiment/declared_metrics.h"
#include "core/app/files/csv.h"
#include "core/app/files/json_file.h"
#include "core/app/files/snapshot_file.h"
#include "core/app/report/run_file.h"

namespace drape {

// Names that a run writes, the only ones that --overwrite may remove: files, and patterns of those in its
// folders. Its method may have had any name.
inline constexpr const char* own_files[] = {"config.yaml", "results.json", "report.html", "iterations.csv",
                                            "log.jsonl",   "errors.csv",   "start.ply",   "reference.ply"};
inline constexpr std::pair<const char*, const char*> own_folders[] = {
    {"levels", R"(.+_l\d+\.(ply|vtp)|.+\.pvd)"},
    {"fields", R"(.+_l\d+_l\d+\.ply)"},
    {"rest", R"(l\d+\.ply)"},
    {"pictures", R"(.+_l\d+(_.+)?\.png)"},
    {"obstacles", R"(\d+\.ply)"},
    {"snapshots", R"(.+_l\d+\.bin)"},
    {"checkpoint", R"((state|previous|next)\.bin)"}};
/// Whether the name is one of these, in that folder of a run; "" is the run's own.
bool is_file_of_run(const std::string& folder, const std::string& name);

/// One level of one method.
struct LevelRecord {
  int level = 0;
  std::string status, message;
  RunFile mesh;                     ///< of the final state; none if the level failed
  bool from_initial_state = false;  ///< earlier levels do not contribute
  Json values;                      ///< costs, quantities and state metrics, in SI units

  /// States on the way, the last of which is the final state; null without any.
  const Json& snapshots() const;
};

/// Pair metrics of a coarse state, prolonged, against a finer one.
struct ConsistencyRecord {
  int coarse = 0, fine = 0;
  Json values;
  RunFile fields;  ///< of the finest state; may be none
};

struct MethodRecord {
  std::string name, status;
  std::string solver;               ///< its type: a method is named in the experiment
  std::vector<LevelRecord> levels;  ///< coarse to fine
  std::vector<ConsistencyRecord> consistency;

  /// Cost of the last state: the sum of the known values over the levels that it builds on.
  OptionalNumber cost(const std::string& value) const;
  /// The coarsest level that the last state builds on.
  int first_level() const;
  /// The levels with a stored final state, coarse to fine.
  std::vector<const LevelRecord*> recorded_levels() const;
};

struct ObstacleRecord {
  RunFile mesh;
  std::string name;  ///< may be empty
};

/// Everything a finished or interrupted run has written, except meshes.
struct RunData {
  std::filesystem::path folder;
  Json results;  ///< results.json as a whole
  std::string experiment;
  std::string configuration;  ///< config.yaml, also parsed; empty without one
  ConfigNode config;
  bool complete = false;
  std::vector<ObstacleRecord> obstacles;
  std::vector<DeclaredMetric> metrics;
  std::vector<MethodRecord> methods;
  Csv iterations, errors;  ///< iterations.csv and errors.csv; empty without them
  std::string reference;   ///< method whose end errors are measured against; empty for a file or none

  /// Whether the run is complete and every method converged.
  bool converged() const;
  /// Whether the run had contact: otherwise it has no gaps and intersections.
  bool has_contact() const;
  int finest_level() const;  ///< over all methods; -1 without levels

  /// A level's rest shape.
  RunFile rest(int level) const;
  /// The snapshots of a level of n vertices, in order; none if the run has recorded none. Throws
  /// std::runtime_error for a file that is missing or damaged.
  SnapshotFile snapshots(const LevelRecord& level, Eigen::Index n) const;
};

/// For faults of what a run's results.json says.
JsonFile results_file(const std::filesystem::path& folder);

/// The mesh that a level's record in it names. Throws std::runtime_error as RunFile::of.
RunFile level_mesh(const JsonFile& results, const Json& level);

/// A level's rest shape, relative to a run's folder.
std::string rest_file(int level);

/// The results.json of a run's folder. Throws std::runtime_error, with that remedy, if it is missing, cut
/// short or not a run's.
Json read_results(const std::filesystem::path& folder,
                  const std::string& remedy = "run the experiment again");
/// The results.json of a complete run; null if the run is not complete, or if they are missing or damaged.
Json complete_results(const std::filesystem::path& folder);

/// Reads results.json (required), iterations.csv, errors.csv and config.yaml (optional). Null values are
/// absent. Throws std::runtime_error with one line if results.json is missing or damaged.
RunData read_run(const std::filesystem::path& folder);

}  // namespace drape
