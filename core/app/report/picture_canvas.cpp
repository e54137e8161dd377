#include "core/app/report/picture_canvas.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "core/app/picture/surface.h"
#include "core/kernel/mesh/file.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/mesh/message_text.h"

namespace drape {

namespace {

constexpr int picture_width = 900, picture_height = 700, map_size = 700;

/// A mesh with validated indices.
TriangleMesh checked_mesh(const std::filesystem::path& path) {
  TriangleMesh mesh = read_mesh(path);
  const bool inside = mesh.triangles.size() == 0 ||
                      (mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < mesh.vertices.rows());
  if (!inside) throw std::runtime_error(path.string() + ": a triangle names a vertex that is not there");
  return mesh;
}

/// The points of an obstacle that a picture of the cloth includes: not the far ends of a floor.
Positions near_cloth(const Positions& obstacle, const std::vector<const Positions*>& states) {
  Eigen::AlignedBox3d box;
  for (const Positions* x : states)
    for (Eigen::Index i = 0; i < x->rows(); ++i)
      if (x->row(i).allFinite()) box.extend(x->row(i).transpose());
  const double margin = box.isEmpty() ? 0 : box.diagonal().norm() / 4;
  const Eigen::AlignedBox3d near(box.min().array() - margin, box.max().array() + margin);
  Positions chosen(obstacle.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < obstacle.rows(); ++i)
    if (near.contains(obstacle.row(i).transpose())) chosen.row(count++) = obstacle.row(i);
  chosen.conservativeResize(count, 3);
  return chosen;
}

/// The least height of all points; none without points.
std::optional<double> lowest(const std::vector<const Positions*>& states) {
  std::optional<double> least;
  for (const Positions* x : states)
    for (Eigen::Index i = 0; i < x->rows(); ++i)
      if (x->row(i).allFinite()) least = std::min(least.value_or((*x)(i, 2)), (*x)(i, 2));
  return least;
}

}  // namespace

PictureCanvas::PictureCanvas(const RunData& run, const std::function<bool()>& leave, PictureSet& set)
    : run_(run), leave_(leave), set_(set) {
  std::vector<const Positions*> all;
  for (const MethodRecord& method : run_.methods) {
    for (const LevelRecord& level : method.levels) {
      if (auto mesh = try_mesh(level.mesh)) {
        all.push_back(&states_.insert_or_assign({method.name, level.level}, *mesh).first->second.vertices);
      }
    }
  }
  std::vector<TriangleMesh> obstacles;
  for (const std::string& name : run_.obstacles)
    if (auto mesh = try_mesh(name)) obstacles.push_back(std::move(*mesh));
  obstacle_ = merged(obstacles);
  const Positions near = near_cloth(obstacle_.vertices, all);
  if (near.rows() > 0) all.push_back(&near);
  floor_ = lowest(all);
  // Three quarters from above: the top shows how it lies, the side how it folds.
  camera_ = Camera::around(all, {0.55, -1.0, 0.68}, double(picture_width) / picture_height);
}

std::optional<TriangleMesh> PictureCanvas::try_mesh(const std::string& name) {
  const std::filesystem::path path = run_.folder / name;
  if (name.empty() || !std::filesystem::is_regular_file(path)) return {};
  try {
    return checked_mesh(path);
  } catch (const std::exception& error) {
    set_.notes.emplace_back(reason_of(error));
    return {};
  }
}

const TriangleMesh* PictureCanvas::state(const std::string& method, int level) const {
  const auto found = states_.find({method, level});
  return found == states_.end() ? nullptr : &found->second;
}

const Triangles* PictureCanvas::triangles_of(Eigen::Index vertex_count) const {
  for (const auto& [key, mesh] : states_) {
    if (mesh.vertices.rows() == vertex_count) return &mesh.triangles;
  }
  return nullptr;
}

void PictureCanvas::draw(const std::string& name, Drawing drawing) {
  if (!renderer_) renderer_ = std::make_unique<Renderer>(picture_width, picture_height, leave_);
  drawing.obstacle = obstacle_.triangles.rows() > 0 ? &obstacle_ : nullptr;
  drawing.floor = floor_;
  keep(name, renderer_->draw(drawing, camera_));
}

void PictureCanvas::draw_map(const std::string& name, const TriangleMesh& flat, const Colours& colours) {
  if (!map_renderer_) map_renderer_ = std::make_unique<Renderer>(map_size, map_size, leave_);
  keep(name, map_renderer_->draw({flat, nullptr, &colours, false, false}, Camera::facing(flat, 1)));
}

void PictureCanvas::keep(const std::string& name, Image image) {
  std::string png = encode_png(image);
  write_file(run_.folder / "pictures" / name, png);
  set_.pictures.insert_or_assign(name, Picture{std::move(image), std::move(png)});
}

}  // namespace drape
