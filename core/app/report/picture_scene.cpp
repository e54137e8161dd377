#include "core/app/report/picture_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/app/picture/surface.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

int picture_height(int width) { return static_cast<int>(std::lround(width * 7.0 / 9)); }

namespace {

constexpr int most_vertices_with_edges = 4000;  // more lines would merge

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

TriangleMesh run_mesh(const RunData& run, const std::string& name) {
  const std::filesystem::path path = run.folder / name;
  TriangleMesh mesh = read_mesh(path);
  const bool inside = mesh.triangles.size() == 0 ||
                      (mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < mesh.vertices.rows());
  if (!inside) throw std::runtime_error(path.string() + ": a triangle names a vertex that is not there");
  return mesh;
}

std::optional<TriangleMesh> try_run_mesh(const RunData& run, const std::string& name,
                                         std::vector<std::string>& notes) {
  if (name.empty()) return {};
  try {
    return run_mesh(run, name);
  } catch (const std::exception& error) {
    const std::string note = reason_of(error);
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
    return {};
  }
}

Drawing plain_cloth(const TriangleMesh& state) {
  return {.mesh = state, .edges = state.vertices.rows() <= most_vertices_with_edges};
}

Eigen::Vector3f outline_colour() { return Eigen::Vector3f(0x0b, 0x62, 0xa8) / 255; }

PictureScene::PictureScene(const RunData& run, std::vector<std::string>& notes, const PictureFrame& frame) {
  std::vector<const Positions*> all;
  for (const MethodRecord& method : run.methods) {
    for (const LevelRecord& level : method.levels) {
      if (auto mesh = try_run_mesh(run, level.mesh, notes)) {
        all.push_back(&states_.insert_or_assign({method.name, level.level}, *mesh).first->second.vertices);
      }
    }
  }
  all.insert(all.end(), frame.further.begin(), frame.further.end());
  std::vector<TriangleMesh> obstacles;
  for (const std::string& name : run.obstacles)
    if (auto mesh = try_run_mesh(run, name, notes)) obstacles.push_back(std::move(*mesh));
  obstacle_ = merged(obstacles);
  const Positions near = near_cloth(obstacle_.vertices, all);
  if (near.rows() > 0) all.push_back(&near);
  floor_ = lowest(all);
  const double aspect = double(frame.width) / picture_height(frame.width);
  camera_ = Camera::around(all, frame.direction, aspect);
}

const TriangleMesh* PictureScene::state(const std::string& method, int level) const {
  const auto found = states_.find({method, level});
  return found == states_.end() ? nullptr : &found->second;
}

const Triangles* PictureScene::triangles_of(Eigen::Index vertex_count) const {
  for (const auto& [key, mesh] : states_) {
    if (mesh.vertices.rows() == vertex_count) return &mesh.triangles;
  }
  return nullptr;
}

Image PictureScene::draw(const Renderer& renderer, Drawing drawing) const {
  drawing.obstacle = obstacle_.triangles.rows() > 0 ? &obstacle_ : nullptr;
  drawing.floor = floor_;
  return renderer.draw(drawing, camera_);
}

}  // namespace drape
