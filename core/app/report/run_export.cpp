#include "core/app/report/run_export.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/app/experiment/method_choice.h"
#include "core/app/files/file_name.h"
#include "core/app/files/gltf.h"
#include "core/app/picture/surface.h"
#include "core/app/report/recorded_snapshots.h"
#include "core/app/report/run_data.h"
#include "core/kernel/files/file.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/plugin/string_utils.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

const MethodRecord& chosen_method(const RunData& run, const std::string& asked) {
  std::vector<std::string> names;
  for (const MethodRecord& method : run.methods) names.push_back(method.name);
  const std::string name = asked.empty() ? default_method(names) : asked;
  for (const MethodRecord& method : run.methods)
    if (method.name == name) return method;
  throw std::runtime_error(asked.empty() ? "--method is missing: the run's methods are " + joined(names)
                                         : "--method " + asked + ": the run's methods are " + joined(names));
}

/// The levels with a recorded state, coarse to fine, or the one that is asked for.
std::vector<const LevelRecord*> recorded_levels(const MethodRecord& method, std::optional<int> asked) {
  std::vector<const LevelRecord*> all;
  std::vector<std::string> known;
  for (const LevelRecord& level : method.levels) {
    if (level.mesh.empty()) continue;
    known.push_back(std::to_string(level.level));
    if (!asked || level.level == *asked) all.push_back(&level);
  }
  if (known.empty()) throw std::runtime_error(method.name + " has not finished a level; nothing to export");
  if (all.empty())
    throw std::runtime_error("--level " + std::to_string(*asked) + ": the levels of " + method.name +
                             " are " + joined(known));
  return all;
}

GltfState gltf_state(const TriangleMesh& mesh) {
  Positions normals = smooth_normals(mesh);
  for (Eigen::Index i = 0; i < normals.rows(); ++i)
    if (!(normals.row(i).squaredNorm() > 0.5)) normals.row(i) << 0, 0, 1;  // glTF asks for length 1
  return {mesh.vertices, std::move(normals)};
}

/// The snapshots before the final state. Throws std::runtime_error if the run has none.
std::vector<GltfState> earlier_states(const RunData& run, const MethodRecord& method,
                                      const LevelRecord& level, const TriangleMesh& last) {
  std::vector<Positions> snapshots = snapshot_positions(run, method, level, last.vertices.rows(), 2);
  snapshots.pop_back();
  std::vector<GltfState> states;
  for (Positions& x : snapshots) states.push_back(gltf_state({std::move(x), last.triangles}));
  return states;
}

GltfSurface cloth_surface(const RunData& run, const MethodRecord& method, const LevelRecord& level,
                          bool with_frames) {
  const TriangleMesh mesh = read_mesh(run.folder / level.mesh);
  const TriangleMesh rest = read_mesh(run.folder / "rest" / ("l" + std::to_string(level.level) + ".ply"));
  if (rest.vertices.rows() != mesh.vertices.rows())
    throw std::runtime_error((run.folder / level.mesh).string() +
                             ": has other vertices than the rest shape; run the experiment again");
  GltfSurface surface;
  surface.name = method.name + " level " + std::to_string(level.level);
  surface.triangles = mesh.triangles;
  surface.state = gltf_state(mesh);
  surface.uv = rest.vertices.leftCols<2>();
  if (with_frames) surface.earlier = earlier_states(run, method, level, mesh);
  return surface;
}

std::string gltf_of(const RunData& run, const MethodRecord& method,
                    const std::vector<const LevelRecord*>& levels, bool with_frames) {
  std::vector<GltfSurface> surfaces;
  std::vector<int> obstacles;
  for (const std::string& name : run.obstacles) {
    const TriangleMesh mesh = read_mesh(run.folder / name);
    if (mesh.triangles.rows() == 0) continue;
    GltfSurface surface;
    surface.name = "obstacle " + std::to_string(surfaces.size());
    surface.material = GltfMaterial::obstacle;
    surface.triangles = mesh.triangles;
    surface.state = gltf_state(mesh);
    obstacles.push_back(static_cast<int>(surfaces.size()));
    surfaces.push_back(std::move(surface));
  }
  std::vector<GltfScene> scenes;
  for (const LevelRecord* level : levels) {
    GltfScene scene{"level " + std::to_string(level->level), obstacles};
    scene.surfaces.push_back(static_cast<int>(surfaces.size()));
    surfaces.push_back(cloth_surface(run, method, *level, with_frames));
    scenes.push_back(std::move(scene));
  }
  return glb_bytes(surfaces, scenes);
}

/// Throws std::runtime_error for a file of an unknown format, and for options that its format does not have.
void check_options(const fs::path& file, const ExportOptions& options) {
  const std::string extension = file.extension().string();
  const std::vector<std::string> known = {".glb", ".obj", ".ply", ".vtp", ".png"};
  if (std::find(known.begin(), known.end(), extension) == known.end())
    throw std::runtime_error("--to " + file.string() +
                             ": the formats are .glb (glTF 2.0), .obj, .ply, .vtp and .png (pictures)");
  if (options.frames && extension != ".glb" && extension != ".png")
    throw std::runtime_error("--frames makes an animation, which " + extension +
                             " cannot hold; take .glb, or .png for numbered pictures");
  const PictureOptions& picture = options.picture;
  if (extension != ".png" && (picture.width || picture.direction || picture.outline))
    throw std::runtime_error("--width, --view and --outline are of pictures; take .png");
}

}  // namespace

std::vector<fs::path> export_run(const fs::path& folder, const fs::path& file, const ExportOptions& options) {
  check_options(file, options);
  const std::string extension = file.extension().string();
  const RunData run = read_run(folder);
  const MethodRecord& method = chosen_method(run, options.method);
  std::vector<const LevelRecord*> levels = recorded_levels(method, options.level);
  const bool all_levels = extension == ".glb" ? !options.frames : extension == ".png" && options.frames;
  if (!all_levels) levels = {levels.back()};
  if (extension == ".png")
    return export_pictures(run, method, levels, options.frames, options.picture, file, options.overwrite);
  refuse_target(file, options.overwrite);
  if (extension == ".glb")
    write_file(file, gltf_of(run, method, levels, options.frames));
  else if (extension == ".vtp")
    write_vtp(file, read_mesh(run.folder / levels[0]->mesh));
  else
    write_mesh(file, read_mesh(run.folder / levels[0]->mesh));
  return {file};
}

}  // namespace drape
