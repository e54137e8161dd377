#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/app/report/pictures.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/file.h"

namespace drape {

/// Options of `export_run`.
struct ExportOptions {
  std::string method;        ///< empty: see default_method
  std::optional<int> level;  ///< empty: every level of a .glb and of numbered pictures, or the finest
  bool frames = false;  ///< the recorded snapshots: of one level, as an animation in a .glb; or as pictures
  PictureOptions picture;  ///< of a .png alone; by default twice as wide as a report's
  bool rest = false;       ///< a level's rest shape, by default the finest one's, in place of a state
  bool as_read = false;  ///< in the unit and axes of the cloth's file; on its mesh's level with its vertices
  std::string uv_unit = {};  ///< of the texture coordinates of flat pieces; empty: as they came
  bool overwrite = false;    ///< replace existing files
  Existing existing() const { return overwrite ? Existing::replaced : Existing::kept; }
};

/// Throws std::runtime_error if a file cannot be written there, if it is there already and not to be
/// replaced, or if it is a run's own.
void refuse_target(const std::filesystem::path& file, bool overwrite);

/// Writes states of a method from a run's folder, by the file's extension, and returns the files. A .glb has
/// each level as a scene, the obstacles included, and opens on the finest. A .obj, .ply or .vtp has the cloth
/// of one level, its pieces as groups, all but .vtp with texture coordinates: those of the cloth's file, or
/// PlanarUv of a flat rest shape; a .glb has those of flat pieces over the pieces' longest extent. A .png has
/// a report's camera, which moves back where a snapshot would leave the picture; of several pictures the
/// files are numbered, FILE_0000.png. Throws std::runtime_error with one line for a folder without results,
/// for a state that was not recorded, for options that do not fit, and for a file that exists.
std::vector<std::filesystem::path> export_run(const std::filesystem::path& folder,
                                              const std::filesystem::path& file,
                                              const ExportOptions& options);

/// Writes the ends of all runs of a sweep that pass as a data set into a folder: NAME.obj as export_run does,
/// with NAME.json, which has the run's row of the table, the experiment, and the fields at the vertices of
/// the OBJ; obstacles as OBJ, each once; index.csv, the table with the names of the files; and index.html,
/// the sweep's page. Returns the table. Throws std::runtime_error with one line as export_run does.
RunTable export_data_set(const std::filesystem::path& sweep, const std::filesystem::path& folder,
                         const ExportOptions& options);

}  // namespace drape
