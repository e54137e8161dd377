#include "core/app/report/picture_export.h"

#include <string>
#include <utility>

#include "core/app/files/file_name.h"
#include "core/app/picture/outline.h"
#include "core/app/report/picture_scene.h"
#include "core/app/report/recorded_snapshots.h"
#include "core/kernel/files/file.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

constexpr int default_width = 2 * default_picture_width;

/// The final state of a level, or all its snapshots, the last of which is that state.
std::vector<TriangleMesh> states_of(const RunData& run, const MethodRecord& method, const LevelRecord& level,
                                    bool snapshots) {
  TriangleMesh last = run_mesh(run, level.mesh);
  std::vector<TriangleMesh> states;
  if (snapshots) {
    // A level that its first state solved has one snapshot.
    std::vector<Positions> earlier = snapshot_positions(run, method, level, last.vertices.rows(), 1);
    earlier.pop_back();
    for (Positions& x : earlier) states.push_back({std::move(x), last.triangles});
  }
  states.push_back(std::move(last));
  return states;
}

/// FILE_0000.png, FILE_0001.png, …
fs::path numbered(const fs::path& file, std::size_t k) {
  std::string number = std::to_string(k);
  if (number.size() < 4) number.insert(0, 4 - number.size(), '0');
  return file.parent_path() / (file.stem().string() + "_" + number + file.extension().string());
}

/// Pictures of an earlier, longer series, which would be read as this one's.
void remove_from(const fs::path& file, std::size_t first) {
  for (std::size_t k = first; fs::is_regular_file(numbered(file, k)); ++k) fs::remove(numbered(file, k));
}

}  // namespace

std::vector<fs::path> export_pictures(const RunData& run, const MethodRecord& method,
                                      const std::vector<const LevelRecord*>& levels, bool snapshots,
                                      const PictureOptions& options, const fs::path& file, bool overwrite) {
  std::vector<TriangleMesh> states;
  for (const LevelRecord* level : levels)
    for (TriangleMesh& state : states_of(run, method, *level, snapshots)) states.push_back(std::move(state));
  std::vector<fs::path> files;
  for (std::size_t k = 0; k < states.size(); ++k) files.push_back(snapshots ? numbered(file, k) : file);
  for (const fs::path& each : files) refuse_target(each, overwrite);
  if (snapshots) refuse_target(numbered(file, files.size()), overwrite);

  PictureFrame frame;
  frame.width = options.width.value_or(default_width);
  if (options.direction) frame.direction = *options.direction;
  for (const TriangleMesh& state : states) frame.further.push_back(&state.vertices);
  std::vector<std::string> notes;  // the report has them: meshes of states that are not drawn here
  const PictureScene scene(run, notes, frame);

  std::optional<TriangleMesh> coarsest;
  for (const LevelRecord& level : method.levels)
    if (options.outline && !coarsest && !level.mesh.empty()) coarsest = run_mesh(run, level.mesh);
  const Renderer renderer(frame.width, picture_height(frame.width));
  for (std::size_t k = 0; k < states.size(); ++k) {
    Drawing drawing = plain_cloth(states[k]);
    drawing.xray = options.xray;
    Image image = scene.draw(renderer, drawing);
    if (coarsest) draw_outline(image, *coarsest, scene.camera(), outline_colour());
    write_file(files[k], encode_png(image));
  }
  if (snapshots) remove_from(file, files.size());
  return files;
}

}  // namespace drape
