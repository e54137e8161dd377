#pragma once

#include <vector>

#include "core/app/files/snapshot_file.h"
#include "core/app/report/run_data.h"

namespace drape {

/// The snapshots of a level of n vertices, in order; none if the run has recorded none. Throws
/// std::runtime_error for a file that is missing or damaged.
SnapshotFile recorded_snapshots(const RunData& run, const LevelRecord& level, Eigen::Index n);

/// Their positions. Throws std::runtime_error, for the option --frames, if there are fewer than `least`.
std::vector<Positions> snapshot_positions(const RunData& run, const MethodRecord& method,
                                          const LevelRecord& level, Eigen::Index n, std::size_t least);

}  // namespace drape
