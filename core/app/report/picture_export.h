#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/app/report/run_data.h"

namespace drape {

/// How exported pictures look; the defaults are a report's, at twice the size.
struct PictureOptions {
  std::optional<int> width;                  ///< [pixels]
  std::optional<Eigen::Vector3d> direction;  ///< towards the camera; of any length but 0
  bool outline = false;                      ///< draw the outline of the method's coarsest state
  bool xray = false;                         ///< let obstacles show faintly through the cloth
};

/// Writes the final states of these levels as PNG files, or with `snapshots` all their recorded snapshots in
/// order, and returns the files. Several pictures are numbered: FILE_0000.png. The camera is that of the
/// report's pictures; it moves back where a snapshot would leave the picture. Throws std::runtime_error for a
/// state that cannot be read, and before it draws for a file that exists, unless it may overwrite.
std::vector<std::filesystem::path> export_pictures(const RunData& run, const MethodRecord& method,
                                                   const std::vector<const LevelRecord*>& levels,
                                                   bool snapshots, const PictureOptions& options,
                                                   const std::filesystem::path& file, bool overwrite);

}  // namespace drape
