#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace drape {

/// What `export_run` writes.
struct ExportOptions {
  std::string method;        ///< empty: see default_method
  std::optional<int> level;  ///< empty: every level of a .glb, or the finest
  bool frames = false;       ///< animate the recorded snapshots of the level, in a .glb
};

/// Writes states of a method from a run's folder, by the file's extension. A .glb has each level as a scene,
/// the obstacles included, and opens on the finest; its texture coordinates are the first two coordinates of
/// the rest shape [m]. A .obj, .ply or .vtp has the cloth of one level. Throws std::runtime_error with one
/// line for a folder without results, for a state that was not recorded, and for options that do not fit.
void export_run(const std::filesystem::path& folder, const std::filesystem::path& file,
                const ExportOptions& options);

}  // namespace drape
