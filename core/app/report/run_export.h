#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/app/report/picture_export.h"

namespace drape {

/// What `export_run` writes.
struct ExportOptions {
  std::string method;        ///< empty: see default_method
  std::optional<int> level;  ///< empty: every level of a .glb and of numbered pictures, or the finest
  bool frames = false;  ///< the recorded snapshots: of one level, as an animation in a .glb; or as pictures
  PictureOptions picture;  ///< of a .png alone
  bool overwrite = false;  ///< replace existing files
};

/// Writes states of a method from a run's folder, by the file's extension, and returns the files. A .glb has
/// each level as a scene, the obstacles included, and opens on the finest. A .obj, .ply or .vtp has the cloth
/// of one level; for a .png see export_pictures. All but .vtp have texture coordinates: those of the cloth's
/// file, or PlanarUv of a flat rest shape. Throws std::runtime_error with one line for a folder without
/// results, for a state that was not recorded, for options that do not fit, and for a file that exists.
std::vector<std::filesystem::path> export_run(const std::filesystem::path& folder,
                                              const std::filesystem::path& file,
                                              const ExportOptions& options);

}  // namespace drape
