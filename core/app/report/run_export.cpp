#include "core/app/report/run_export.h"

#include <unistd.h>

#include <stdexcept>
#include <utility>

#include "core/app/experiment/experiment.h"
#include "core/app/files/gltf.h"
#include "core/app/files/json_file.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/mesh/flat_pieces.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/mesh/texture_coordinates.h"
#include "core/numerics/mesh/unjoined_borders.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/mesh_files/io_formats.h"

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
std::vector<const LevelRecord*> chosen_levels(const MethodRecord& method, std::optional<int> asked) {
  std::vector<const LevelRecord*> levels = method.recorded_levels();
  if (levels.empty()) throw std::runtime_error(method.name + " has not finished a level; nothing to export");
  std::vector<std::string> known;
  for (const LevelRecord* level : levels) known.push_back(std::to_string(level->level));
  std::erase_if(levels, [&](const LevelRecord* level) { return asked && level->level != *asked; });
  if (levels.empty())
    throw std::runtime_error("--level " + std::to_string(*asked) + ": the levels of " + method.name +
                             " are " + joined(known));
  return levels;
}

/// The cloth at the end of a level, with texture coordinates: those of the cloth's file, or, for a flat rest
/// shape, its own plane's, which are the same on every level. Throws std::runtime_error if the rest shape has
/// other triangles.
TriangleMesh cloth_mesh(const RunData& run, const LevelRecord& level) {
  TriangleMesh mesh = run.rest(level.level).mesh(), state = level.mesh.mesh();
  if (mesh.triangles.rows() != state.triangles.rows())
    throw std::runtime_error((run.folder / "rest").string() + ": level " + std::to_string(level.level) +
                             " has other triangles than its state; run the experiment again");
  if (mesh.uv.rows() == 0)
    if (const auto planar = PlanarUv::of(level.level == 0 ? mesh : run.rest(0).mesh()))
      mesh.uv = planar->at(mesh);
  mesh.vertices = std::move(state.vertices);
  mesh.warp.resize(0, 3);  // in the rest shape's corners
  return mesh;
}

/// A level's mesh in the unit and the axes of the file that the cloth was read from; on the level of that
/// file's mesh with its vertices and faces.
TriangleMesh mesh_as_read(const RunData& run, int level, TriangleMesh mesh) {
  ConfigErrors unread;
  const ExperimentParameters p = parameters_of(run.config, unread);
  const AsReadParameters& read = p.cloth.as_read;
  if (read.file.empty()) throw std::runtime_error("--as-read: the run's cloth is not of a file");
  mesh.vertices = read.in_file(mesh.vertices);
  if (level != p.hierarchy.coarsen) return mesh;
  TriangleMesh own = read_mesh(read.file), joined = own;
  read.convert(joined.vertices);
  joined.vertices *= read.scale;
  const std::vector<int> vertex = join_vertices(joined, read.join);
  if (!same_entries(joined.triangles, mesh.triangles))
    throw std::runtime_error(
        "--as-read: " + read.file +
        " has other faces than when the run read it, or the run meshed them anew, by \"edge_length\" or "
        "\"vertices\"");
  own.vertices = mesh.vertices(vertex, Eigen::all);
  return own;
}

/// Converts texture coordinates of flat pieces to a unit of length, or to those of a picture.
void convert_uv(TriangleMesh& mesh, const std::string& unit) {
  if (!mesh.sewing) throw std::runtime_error("--uv-unit is of flat pieces; the run's cloth has none");
  Positions metres = Eigen::RowVector3d::UnitX();
  FileCoordinates{unit}.convert(metres);
  if (unit == "normalised")
    mesh.sewing->uv_length = scale_to_picture(mesh);
  else
    mesh.uv *= std::exchange(mesh.sewing->uv_length, metres(0, 0)) / metres(0, 0);
}

/// A level's mesh as the options want it, as bytes of a .obj, .ply or .vtp.
std::string mesh_bytes(const RunData& run, int level, TriangleMesh mesh, const VertexFields& fields,
                       const std::string& extension, const ExportOptions& options) {
  if (options.as_read) mesh = mesh_as_read(run, level, std::move(mesh));
  if (!options.uv_unit.empty()) convert_uv(mesh, options.uv_unit);
  if (extension == ".obj") return obj_text(mesh);
  if (extension == ".vtp") return vtp_text(mesh, fields);
  return ply_bytes(mesh, options.as_read ? VertexFields() : fields);
}

/// Why a level has fewer snapshots than an animation needs, with a remedy.
std::string fault_of_snapshots(const MethodRecord& method, const LevelRecord& level, std::size_t count,
                               std::size_t least) {
  const std::string name = "level " + std::to_string(level.level);
  if (count == 0) return "the run has no snapshots of " + name + "; run the experiment with snapshots: 8";
  if (number_member(level.values, "iterations").value_or(0) > 1)
    return "the run has only the last state of " + name + "; run the experiment with snapshots: 8";
  std::vector<std::string> others;
  for (const LevelRecord& other : method.levels)
    if (member_of(other.snapshots(), "iterations").size() >= least)
      others.push_back("--level " + std::to_string(other.level));
  return name + " of " + method.name +
         " took no more than one iteration, so it has no state before its last; " +
         (others.empty() ? "export it without --frames" : "choose " + joined(others));
}

/// A level's snapshots before its final state. Throws std::runtime_error, for the option --frames, if there
/// are fewer than `least` with that one.
std::vector<Positions> earlier_states(const RunData& run, const MethodRecord& method,
                                      const LevelRecord& level, Eigen::Index n, std::size_t least) {
  const SnapshotFile states = run.snapshots(level, n);
  if (states.count() < least)
    throw std::runtime_error("--frames: " + fault_of_snapshots(method, level, states.count(), least));
  std::vector<Positions> all;
  for (std::size_t k = 0; k + 1 < states.count(); ++k) all.push_back(states.positions(k));
  return all;
}

/// The mesh, with its normals, at the vertices that its texture coordinates split. `earlier`: its vertices in
/// states before.
GltfSurface gltf_surface(const std::string& name, GltfMaterial material, TriangleMesh mesh,
                         const std::vector<Positions>& earlier = {}) {
  const double uv_length = scale_to_picture(mesh);
  const UvVertices split = split_at_seams(mesh);
  const auto state = [&](const Positions& x) {
    Positions normals = smooth_normals({x, mesh.triangles});
    for (Eigen::Index i = 0; i < normals.rows(); ++i)
      if (!(normals.row(i).squaredNorm() > 0.5)) normals.row(i) << 0, 0, 1;  // glTF asks for length 1
    return GltfState{split.of(x), split.of(normals)};
  };
  GltfSurface surface{name, material,  split.triangles, state(mesh.vertices), split.uv,
                      {},   uv_length, mesh.piece,      mesh.piece_names};
  for (const Positions& x : earlier) surface.earlier.push_back(state(x));
  return surface;
}

std::string gltf_of(const RunData& run, const MethodRecord& method,
                    const std::vector<const LevelRecord*>& levels, bool with_frames) {
  std::vector<GltfSurface> surfaces;
  std::vector<int> obstacles;
  for (std::size_t k = 0; k < run.obstacles.size(); ++k) {
    TriangleMesh mesh = run.obstacles[k].mesh.mesh();
    if (mesh.triangles.rows() == 0) continue;
    const std::string& given = run.obstacles[k].name;
    const std::string name = given.empty() ? "obstacle " + std::to_string(k) : given;
    obstacles.push_back(static_cast<int>(surfaces.size()));
    surfaces.push_back(gltf_surface(name, GltfMaterial::obstacle, std::move(mesh)));
  }
  const std::string cloth = run.experiment.empty() ? "cloth" : run.experiment;
  std::vector<GltfScene> scenes;
  for (const LevelRecord* level : levels) {
    const std::string name = "level " + std::to_string(level->level);
    scenes.push_back({name, obstacles});
    scenes.back().surfaces.push_back(static_cast<int>(surfaces.size()));
    TriangleMesh mesh = cloth_mesh(run, *level);
    std::vector<Positions> earlier;
    if (with_frames) earlier = earlier_states(run, method, *level, mesh.vertices.rows(), 2);
    surfaces.push_back(gltf_surface(cloth + " " + name, GltfMaterial::cloth, std::move(mesh), earlier));
  }
  return glb_bytes(surfaces, scenes);
}

/// Whether the file is in a run's folder, under a name that a run writes.
bool is_result(const fs::path& file) {
  const fs::path folder = fs::canonical(fs::absolute(file).parent_path());
  const auto is_run = [](const fs::path& p) {
    return fs::exists(p / "results.json") || fs::exists(p / "checkpoint/lock");
  };
  return (is_run(folder) && is_file_of_run("", file.filename())) ||
         (is_run(folder.parent_path()) && is_file_of_run(folder.filename(), file.filename()));
}

/// FILE_0000.png, FILE_0001.png, …
fs::path numbered(const fs::path& file, std::size_t k) {
  std::string number = std::to_string(k);
  if (number.size() < 4) number.insert(0, 4 - number.size(), '0');
  return file.parent_path() / (file.stem().string() + "_" + number + file.extension().string());
}

/// Draws the final states of these levels, or all their snapshots, the last of which is that state.
std::vector<fs::path> export_pictures(const RunData& run, const MethodRecord& method,
                                      const std::vector<const LevelRecord*>& levels, const fs::path& file,
                                      const ExportOptions& options) {
  std::vector<TriangleMesh> states;
  for (const LevelRecord* level : levels) {
    TriangleMesh last = level->mesh.mesh();
    if (options.frames)  // a level that its first state solved has one snapshot
      for (Positions& x : earlier_states(run, method, *level, last.vertices.rows(), 1))
        states.push_back({std::move(x), last.triangles});
    states.push_back(std::move(last));
  }
  std::vector<fs::path> files;
  for (std::size_t k = 0; k < states.size(); ++k) files.push_back(options.frames ? numbered(file, k) : file);
  for (const fs::path& each : files) refuse_target(each, options.overwrite);
  if (options.frames) refuse_target(numbered(file, files.size()), options.overwrite);

  PictureOptions look = options.picture;
  look.width = look.width.value_or(2 * default_picture_width);
  std::vector<const Positions*> drawn;
  for (const TriangleMesh& state : states) drawn.push_back(&state.vertices);
  std::vector<std::string> notes;  // of states that are not drawn here; the report has them
  const PictureScene scene(run, notes, look, drawn);
  std::optional<TriangleMesh> coarsest;
  if (look.outline) coarsest = method.recorded_levels().front()->mesh.mesh();
  for (std::size_t k = 0; k < states.size(); ++k) {
    Image image = scene.draw(states[k]);
    if (coarsest) scene.draw_outline(image, *coarsest);
    write_file(files[k], encode_png(image), options.existing());
  }
  // Pictures of an earlier, longer series would be read as this one's.
  for (std::size_t k = files.size(); options.frames && fs::is_regular_file(numbered(file, k)); ++k)
    fs::remove(numbered(file, k));
  return files;
}

/// Throws std::runtime_error for a file of an unknown format, and for options that its format does not have.
void check_options(const fs::path& file, const ExportOptions& options) {
  const std::string extension = lower_extension(file);
  if (!is_one_of(extension, {".glb", ".obj", ".ply", ".vtp", ".png"}))
    throw std::runtime_error("--to " + file.string() +
                             ": the formats are .glb (glTF 2.0), .obj, .ply, .vtp and .png (pictures)");
  if (options.frames && extension != ".glb" && extension != ".png")
    throw std::runtime_error("--frames makes an animation, which " + extension +
                             " cannot hold; take .glb, or .png for numbered pictures");
  const bool of_mesh = extension == ".obj" || extension == ".ply";
  if (options.as_read && !of_mesh) throw std::runtime_error("--as-read is of meshes; take .obj or .ply");
  if (options.rest && !of_mesh) throw std::runtime_error("--rest is of meshes; take .obj or .ply");
  if (options.rest && !options.method.empty())
    throw std::runtime_error("--method is of states; rest shapes are the same for every method");
  if (!options.uv_unit.empty() && (!of_mesh || options.as_read))
    throw std::runtime_error("--uv-unit is of a .obj or .ply without --as-read");
  const PictureOptions& picture = options.picture;
  if (extension != ".png" && (picture.width || picture.direction || picture.outline || picture.xray ||
                              picture.colours.cloth || picture.colours.dark))
    throw std::runtime_error(
        "--width, --view, --outline, --xray, --colour and --dark are of pictures; take .png");
}

}  // namespace

void refuse_target(const fs::path& file, bool overwrite) {
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) refuse_path(folder, "is no folder; make it, or name another file");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    refuse_path(folder, "cannot be written to; name another file");
  if (fs::is_directory(file, error)) refuse_path(file, "is a folder; name a file");
  if (!overwrite && fs::exists(fs::symlink_status(file, error)))
    refuse_path(file, "exists already; name another file, or replace it with --overwrite");
  if (is_result(file)) refuse_path(file, "is the name of a run's own result; name another file");
}

std::vector<fs::path> export_run(const fs::path& folder, const fs::path& file, const ExportOptions& options) {
  check_options(file, options);
  const std::string extension = lower_extension(file);
  const RunData run = read_run(folder);
  if (options.rest) {
    const int finest = run.finest_level(), level = options.level.value_or(finest);
    if (level > finest)
      throw std::runtime_error("--level " + std::to_string(level) + ": the run's levels go from 0 to " +
                               std::to_string(finest));
    refuse_target(file, options.overwrite);
    write_file(file, mesh_bytes(run, level, run.rest(level).mesh(), {}, extension, options),
               options.existing());
    return {file};
  }
  const MethodRecord& method = chosen_method(run, options.method);
  std::vector<const LevelRecord*> levels = chosen_levels(method, options.level);
  const bool all_levels = extension == ".glb" ? !options.frames : extension == ".png" && options.frames;
  if (!all_levels) levels = {levels.back()};
  if (extension == ".png") return export_pictures(run, method, levels, file, options);
  refuse_target(file, options.overwrite);
  const LevelRecord& level = *levels[0];
  write_file(file,
             extension == ".glb" ? gltf_of(run, method, levels, options.frames)
                                 : mesh_bytes(run, level.level, cloth_mesh(run, level), level.mesh.fields(),
                                              extension, options),
             options.existing());
  return {file};
}

}  // namespace drape
