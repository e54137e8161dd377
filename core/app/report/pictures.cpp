#include "core/app/report/pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/app/picture/render.h"
#include "core/app/picture/surface.h"
#include "core/app/view/colours.h"
#include "core/kernel/mesh/file.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/mesh/message_text.h"
#include "core/kernel/mesh/topology.h"

namespace drape {

namespace {

constexpr int picture_width = 900, picture_height = 700, map_size = 700;
constexpr int most_vertices_with_edges = 4000;  // more lines would merge

/// The fine state of a pair with the curvatures of both; missing fields are empty.
struct PairFields {
  TriangleMesh mesh;
  Eigen::VectorXd H_difference, principal, principal_other;
};

std::string file_part(std::string name) {
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  }
  return name;
}

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

class PictureMaker {
 public:
  PictureMaker(const RunData& run, const std::function<bool()>& leave) : run_(run), leave_(leave) {}

  PictureSet make() {
    make_folder(run_.folder / "pictures");
    try {
      read_states();
      draw_states();
      read_fields();
      draw_H_differences();
      draw_folds();
    } catch (const PictureLeft&) {
      set_.notes.push_back("The run was stopped before all pictures were drawn; drape report " +
                           run_.folder.string() + " draws them.");
    }
    return std::move(set_);
  }

 private:
  using StateKey = std::pair<std::string, int>;
  using PairKey = std::pair<std::string, std::pair<int, int>>;

  std::optional<TriangleMesh> try_mesh(const std::string& name) {
    const std::filesystem::path path = run_.folder / name;
    if (name.empty() || !std::filesystem::is_regular_file(path)) return {};
    try {
      return checked_mesh(path);
    } catch (const std::exception& error) {
      set_.notes.emplace_back(reason_of(error));
      return {};
    }
  }

  void read_states() {
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

  void draw_states() {
    for (const MethodRecord& method : run_.methods) {
      for (const LevelRecord& level : method.levels) {
        const auto state = states_.find({method.name, level.level});
        if (state == states_.end()) continue;
        Drawing drawing{state->second};
        drawing.obstacle = obstacle();
        drawing.floor = floor_;
        drawing.edges = state->second.vertices.rows() <= most_vertices_with_edges;
        keep(state_picture(method, level.level), renderer().draw(drawing, camera_));
      }
    }
  }

  void read_fields() {
    for (const MethodRecord& method : run_.methods) {
      for (const ConsistencyRecord& pair : method.consistency) {
        auto mesh = try_mesh(pair.fields);
        if (!mesh) continue;
        PairFields fields{std::move(*mesh), {}, {}, {}};
        try {
          for (const VertexField& field : read_ply_fields(run_.folder / pair.fields)) {
            if (field.values.size() != fields.mesh.vertices.rows()) continue;
            if (field.name == "H_difference") fields.H_difference = field.values;
            if (field.name == "principal_curvature") fields.principal = field.values;
            if (field.name == "principal_curvature_other") fields.principal_other = field.values;
          }
        } catch (const std::exception& error) {
          set_.notes.emplace_back(reason_of(error));
        }
        fields_.insert_or_assign({method.name, {pair.coarse, pair.fine}}, std::move(fields));
      }
    }
  }

  const PairFields* fields(const MethodRecord& method, int coarse, int fine) const {
    const auto found = fields_.find({method.name, {coarse, fine}});
    return found == fields_.end() ? nullptr : &found->second;
  }

  void draw_H_differences() {
    std::vector<const Eigen::VectorXd*> all;
    for (const MethodRecord& method : run_.methods) {
      const ConsistencyRecord* pair = widest_pair(method);
      const PairFields* f = pair ? fields(method, pair->coarse, pair->fine) : nullptr;
      if (f && f->H_difference.size() > 0) all.push_back(&f->H_difference);
    }
    set_.H_difference_scale = magnitude_quantile(all, H_difference_quantile);
    for (const MethodRecord& method : run_.methods) {
      const ConsistencyRecord* pair = widest_pair(method);
      const PairFields* f = pair ? fields(method, pair->coarse, pair->fine) : nullptr;
      if (!f || f->H_difference.size() == 0) continue;
      const Colours colours = diverging_colours(f->H_difference, set_.H_difference_scale);
      const auto rest = try_mesh("rest/l" + std::to_string(pair->fine) + ".ply");
      const std::string name = H_difference_picture(method, *pair);
      if (rest && rest->vertices.rows() == f->mesh.vertices.rows()) {
        set_.maps_on_rest = true;
        if (!map_renderer_) map_renderer_ = std::make_unique<Renderer>(map_size, map_size, leave_);
        keep(name, map_renderer_->draw({*rest, nullptr, &colours, false, false}, Camera::facing(*rest, 1)));
      } else {
        keep(name, renderer().draw({f->mesh, nullptr, &colours, false, true, obstacle(), floor_}, camera_));
      }
    }
  }

  /// The curvature of a method's finest state, and its mesh.
  const PairFields* finest_fields(const MethodRecord& method) const {
    const PairFields* best = nullptr;
    int finest = -1;
    for (const ConsistencyRecord& pair : method.consistency) {
      const PairFields* f = fields(method, pair.coarse, pair.fine);
      if (f && f->principal.size() > 0 && pair.fine > finest) {
        finest = pair.fine;
        best = f;
      }
    }
    return best;
  }

  void draw_folds() {
    const PairFields* reference = nullptr;
    for (const MethodRecord& method : run_.methods) {
      if (!reference) reference = finest_fields(method);
    }
    if (!reference) return;
    set_.fold_threshold = magnitude_quantile({&reference->principal}, fold_quantile);
    for (const MethodRecord& method : run_.methods) {
      for (const LevelRecord& level : method.levels) {
        try {
          draw_fold(method, level.level);
        } catch (const PictureLeft&) {
          throw;
        } catch (const std::exception& error) {
          set_.notes.push_back(fold_picture(method, level.level) + ": " + reason_of(error));
        }
      }
    }
  }

  /// A coarse level's curvature is given on the finer mesh, so its state is prolonged; the finest level has
  /// its own.
  void draw_fold(const MethodRecord& method, int level) {
    const std::string name = fold_picture(method, level);
    for (auto pair = method.consistency.rbegin(); pair != method.consistency.rend(); ++pair) {
      const PairFields* f = fields(method, pair->coarse, pair->fine);
      const auto state = states_.find({method.name, level});
      if (!f || pair->coarse != level || f->principal_other.size() == 0 || state == states_.end()) continue;
      TriangleMesh mesh = state->second;
      Positions normals = smooth_normals(mesh);
      if (!prolong(mesh, normals, f->mesh.triangles, f->mesh.vertices.rows())) continue;
      const Colours colours = fold_colours(f->principal_other, set_.fold_threshold);
      keep(name, renderer().draw({mesh, &normals, &colours, false, true, obstacle(), floor_}, camera_));
      return;
    }
    for (const ConsistencyRecord& pair : method.consistency) {
      const PairFields* f = fields(method, pair.coarse, pair.fine);
      if (!f || pair.fine != level || f->principal.size() == 0) continue;
      const Colours colours = fold_colours(f->principal, set_.fold_threshold);
      keep(name, renderer().draw({f->mesh, nullptr, &colours, false, true, obstacle(), floor_}, camera_));
      return;
    }
  }

  /// Splits a state 1→4 at edge midpoints, which leaves its surface as it is, until it has `count`
  /// vertices. Relies on the numbering of Refinement: old vertices first, then one an edge. False if
  /// the numbers do not fit or an intermediate level's triangles are not known.
  bool prolong(TriangleMesh& mesh, Positions& normals, const Triangles& finest, Eigen::Index count) const {
    while (mesh.vertices.rows() < count) {
      const int n = static_cast<int>(mesh.vertices.rows());
      const Topology topology = Topology::of(mesh.triangles, n);
      const Eigen::Index next = n + topology.edges.rows();
      const Triangles* triangles = next == count ? &finest : triangles_of(next);
      if (next > count || !triangles) return false;
      mesh.vertices.conservativeResize(next, 3);
      normals.conservativeResize(next, 3);
      for (Eigen::Index e = 0; e < topology.edges.rows(); ++e) {
        const int a = topology.edges(e, 0), b = topology.edges(e, 1);
        mesh.vertices.row(n + e) = (mesh.vertices.row(a) + mesh.vertices.row(b)) / 2;
        normals.row(n + e) = (normals.row(a) + normals.row(b)).normalized();
      }
      mesh.triangles = *triangles;
    }
    return mesh.vertices.rows() == count;
  }

  const Triangles* triangles_of(Eigen::Index vertex_count) const {
    for (const auto& [key, mesh] : states_) {
      if (mesh.vertices.rows() == vertex_count) return &mesh.triangles;
    }
    return nullptr;
  }

  const TriangleMesh* obstacle() const { return obstacle_.triangles.rows() > 0 ? &obstacle_ : nullptr; }

  Renderer& renderer() {
    if (!renderer_) renderer_ = std::make_unique<Renderer>(picture_width, picture_height, leave_);
    return *renderer_;
  }

  void keep(const std::string& name, Image image) {
    std::string png = encode_png(image);
    write_file(run_.folder / "pictures" / name, png);
    set_.pictures.insert_or_assign(name, Picture{std::move(image), std::move(png)});
  }

  const RunData& run_;
  const std::function<bool()>& leave_;
  PictureSet set_;
  std::map<StateKey, TriangleMesh> states_;
  std::map<PairKey, PairFields> fields_;
  TriangleMesh obstacle_;
  Camera camera_;
  std::optional<double> floor_;
  std::unique_ptr<Renderer> renderer_, map_renderer_;
};

}  // namespace

const Picture* PictureSet::find(const std::string& name) const {
  const auto found = pictures.find(name);
  return found == pictures.end() ? nullptr : &found->second;
}

std::string state_picture(const MethodRecord& method, int level) {
  return file_part(method.name) + "_l" + std::to_string(level) + ".png";
}

std::string fold_picture(const MethodRecord& method, int level) {
  return file_part(method.name) + "_l" + std::to_string(level) + "_folds.png";
}

std::string H_difference_picture(const MethodRecord& method, const ConsistencyRecord& pair) {
  return file_part(method.name) + "_l" + std::to_string(pair.coarse) + "_l" + std::to_string(pair.fine) +
         "_H_difference.png";
}

const ConsistencyRecord* widest_pair(const MethodRecord& method) {
  const ConsistencyRecord* widest = nullptr;
  for (const ConsistencyRecord& pair : method.consistency) {
    const bool wider = !widest || pair.coarse < widest->coarse ||
                       (pair.coarse == widest->coarse && pair.fine > widest->fine);
    if (wider) widest = &pair;
  }
  return widest;
}

PictureSet draw_pictures(const RunData& run, const std::function<bool()>& leave) {
  return PictureMaker(run, leave).make();
}

}  // namespace drape
