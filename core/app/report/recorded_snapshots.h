#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/app/report/run_data.h"
#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// The snapshots of a level, as a run has recorded them; the last one is the level's final state.
struct Snapshots {
  std::string bytes;  ///< float32 positions [m], one snapshot after the other
  nlohmann::ordered_json iterations, seconds;
  std::size_t count = 0;

  /// The positions of a snapshot of n vertices, n×3 [m].
  Positions positions(std::size_t snapshot, Eigen::Index n) const;
};

/// Reads the snapshots of a level of n vertices; `level` is its entry in results.json. None if the run has
/// recorded none. Throws std::runtime_error for a file that is missing or has another size.
Snapshots recorded_snapshots(const std::filesystem::path& folder, const nlohmann::ordered_json& level,
                             Eigen::Index n);

/// The positions of all snapshots of a level of n vertices, in order. Throws std::runtime_error, for the
/// option
/// --frames, if there are fewer than `least`.
std::vector<Positions> snapshot_positions(const RunData& run, const MethodRecord& method,
                                          const LevelRecord& level, Eigen::Index n, std::size_t least);

}  // namespace drape
