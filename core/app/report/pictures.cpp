#include "core/app/report/pictures.h"

#include <Eigen/Geometry>
#include <cctype>
#include <cmath>
#include <list>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/mesh_files/base64.h"

namespace drape {

namespace {

constexpr int most_vertices_with_edges = 4000;  // more lines would merge
/// Towards the camera: three quarters from above. The top shows how the cloth lies, the side how it folds.
const Eigen::Vector3d from_above(0.55, -1.0, 0.68);
/// sRGB: `--accent` of viewer/page.css.
const Eigen::Vector3f outline_colour = Eigen::Vector3f(0x0b, 0x62, 0xa8) / 255;

int height_of(int width) { return static_cast<int>(std::lround(width * 7.0 / 9)); }

/// Whether an obstacle is to be seen as a whole: it is taller than the cloth, as no floor is, and at most
/// three times as large (isBody in viewer/view.js).
bool is_body(const Positions& obstacle, const Eigen::AlignedBox3d& cloth) {
  const Eigen::AlignedBox3d box = bounding_box(obstacle);
  return !box.isEmpty() && !cloth.isEmpty() && box.sizes().z() > cloth.sizes().z() &&
         box.diagonal().norm() <= 3 * cloth.diagonal().norm();
}

/// The points of an obstacle that a picture of the cloth includes: not the far ends of a floor.
Positions near_cloth(const Positions& obstacle, const Eigen::AlignedBox3d& cloth) {
  if (is_body(obstacle, cloth)) return obstacle;
  const double margin = cloth.isEmpty() ? 0 : cloth.diagonal().norm() / 4;
  const Eigen::AlignedBox3d near(cloth.min().array() - margin, cloth.max().array() + margin);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < obstacle.rows(); ++i)
    if (near.contains(obstacle.row(i).transpose())) chosen.push_back(i);
  return obstacle(chosen, Eigen::all);
}

/// The mesh of a file; none, with a note, if it cannot be read.
std::optional<TriangleMesh> mesh_or_note(const RunFile& file, std::vector<std::string>& notes) {
  if (!file.is_named()) return {};
  try {
    return file.mesh();
  } catch (const std::exception& error) {
    add_new(notes, reason_of(error));
    return {};
  }
}

/// Drawing::seams of a mesh.
std::vector<unsigned char> seam_sides(const TriangleMesh& rest) {
  const Topology topology = Topology::of(rest.triangles, static_cast<int>(rest.vertices.rows()));
  std::vector<unsigned char> sides(rest.triangles.rows(), 0);
  for (const int e : seam_edges(rest, topology))
    for (const int t : topology.edge_triangles.row(e)) sides[t] |= 1 << topology.corner_opposite(e, t);
  return sides;
}

/// Keeps a method's name as it is: a run accepts only names of files, and distinct methods need distinct
/// pictures. Only an edited results.json can have anything else.
std::string file_part(std::string name) {
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && !std::isalnum(byte) && c != '-' && c != '.') c = '_';
  }
  return name;
}

}  // namespace

PictureScene::PictureScene(const RunData& run, std::vector<std::string>& notes, const PictureOptions& options,
                           const std::vector<const Positions*>& further, std::function<bool()> cancelled)
    : options_(options),
      width_(options.width.value_or(default_picture_width)),
      cancelled_(std::move(cancelled)) {
  std::vector<const Positions*> all = further;
  for (const MethodRecord& method : run.methods)
    for (const LevelRecord& level : method.levels)
      if (auto mesh = mesh_or_note(level.mesh, notes))
        all.push_back(&states_.emplace(&level, *mesh).first->second.vertices);
  std::vector<std::string> unread;  // rest shapes, which the 3D view notes
  for (int level = 0; level <= run.finest_level(); ++level) {
    const auto rest = mesh_or_note(run.rest(level), unread);
    if (!rest || !rest->sewing) break;
    seams_.emplace(rest->triangles.rows(), seam_sides(*rest));
  }
  Eigen::AlignedBox3d box;
  for (const Positions* x : all) box.extend(bounding_box(*x));
  std::list<Positions> near;
  for (const ObstacleRecord& obstacle : run.obstacles)
    if (auto mesh = mesh_or_note(obstacle.mesh, notes)) {
      all.push_back(&near.emplace_back(near_cloth(mesh->vertices, box)));
      obstacles_.push_back(std::move(*mesh));
    }
  for (const Positions& x : near) box.extend(bounding_box(x));
  if (!box.isEmpty()) floor_ = box.min()[2];
  camera_ = Camera::around(all, options.direction.value_or(from_above), double(width_) / height_of(width_));
}

const TriangleMesh* PictureScene::state(const LevelRecord& level) const {
  const auto found = states_.find(&level);
  return found == states_.end() ? nullptr : &found->second;
}

Image PictureScene::draw(const TriangleMesh& cloth) const {
  Drawing drawing{.mesh = cloth,
                  .edges = options_.edges && cloth.vertices.rows() <= most_vertices_with_edges,
                  .xray = options_.xray,
                  .floor = floor_,
                  .colours = options_.colours};
  if (const auto seams = seams_.find(cloth.triangles.rows()); seams != seams_.end())
    drawing.seams = seams->second;
  for (const TriangleMesh& obstacle : obstacles_) drawing.obstacles.push_back(&obstacle);
  return render(drawing, camera_, width_, height_of(width_), cancelled_);
}

void PictureScene::draw_outline(Image& picture, const TriangleMesh& cloth) const {
  if (cancelled_ && cancelled_()) throw RenderingCancelled();
  drape::draw_outline(picture, cloth, camera_, outline_colour);
}

std::string state_picture(const MethodRecord& method, int level) {
  return file_part(method.name) + "_l" + std::to_string(level) + ".png";
}

std::string outline_picture(const MethodRecord& method, int coarse, int fine) {
  return file_part(method.name) + "_l" + std::to_string(coarse) + "_on_l" + std::to_string(fine) + ".png";
}

PictureSet draw_pictures(const RunData& run, const std::function<bool()>& cancelled,
                         std::optional<int> width) {
  PictureSet set;
  const std::filesystem::path folder = run.folder / "pictures";
  make_folder(folder);
  const PictureScene scene(run, set.notes, {.width = width}, {}, cancelled);
  const auto keep = [&](const std::string& name, Image image) {
    const std::string png = encode_png(image);
    write_file(folder / name, png);
    set.pictures.insert_or_assign(name, std::move(image));
    return base64(png);
  };
  try {
    for (const MethodRecord& method : run.methods) {
      const std::vector<const LevelRecord*> levels = method.recorded_levels();
      for (const LevelRecord& level : method.levels) {
        const std::string name = state_picture(method, level.level);
        // An earlier report may have drawn a state whose mesh is gone.
        std::filesystem::remove(folder / name);
        const TriangleMesh* state = scene.state(level);
        if (!state) continue;
        const std::string png = keep(name, scene.draw(*state));
        if (levels.size() == 1)
          set.ends.push_back({{"method", method.name}, {"png", png}, {"alt", method.name + ": the cloth"}});
      }
      if (levels.size() < 2) continue;
      const int coarse = levels.front()->level, fine = levels.back()->level;
      const std::string name = outline_picture(method, coarse, fine);
      std::filesystem::remove(folder / name);
      const TriangleMesh* preview = scene.state(*levels.front());
      const auto end = set.pictures.find(state_picture(method, fine));
      if (!preview || end == set.pictures.end()) continue;
      Image outlined = end->second;
      scene.draw_outline(outlined, *preview);
      set.ends.push_back({{"method", method.name},
                          {"png", keep(name, std::move(outlined))},
                          {"alt", method.name + ": the end, with the outline of the preview"},
                          {"coarse", coarse},
                          {"fine", fine}});
    }
  } catch (const RenderingCancelled&) {
    set.notes.push_back("Not all pictures were drawn; drape report " + run.folder.string() + " draws them.");
  }
  return set;
}

}  // namespace drape
