#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/app/files/snapshot_file.h"
#include "core/app/report/run_data.h"

namespace drape {

/// The snapshots of a level, as a run has recorded them; the last one is the level's final state.
struct Snapshots {
  SnapshotFile states;
  nlohmann::ordered_json iterations, seconds;
};

/// Reads the snapshots of a level of n vertices; `level` is its entry in results.json. None if the run has
/// recorded none. Throws std::runtime_error for a file that is missing or damaged.
Snapshots recorded_snapshots(const std::filesystem::path& folder, const nlohmann::ordered_json& level,
                             Eigen::Index n);

/// The positions of all snapshots of a level of n vertices, in order. Throws std::runtime_error, for the
/// option --frames, if there are fewer than `least`, and for a file that is missing or damaged.
std::vector<Positions> snapshot_positions(const RunData& run, const MethodRecord& method,
                                          const LevelRecord& level, Eigen::Index n, std::size_t least);

}  // namespace drape
