#include "core/app/report/pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/app/report/midpoint_surface.h"
#include "core/app/report/render.h"
#include "core/app/view/colours.h"
#include "core/kernel/mesh/file.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/mesh/message_text.h"

namespace drape {

namespace {

constexpr int picture_width = 900, picture_height = 700, map_size = 700;
constexpr int most_vertices_with_edges = 4000;  // more lines would merge

/// The fine state of a pair with the fields of its metrics.
struct PairFields {
  TriangleMesh mesh;
  std::map<std::string, Eigen::VectorXd> values;  // one for each vertex

  const Eigen::VectorXd* find(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? nullptr : &found->second;
  }
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

class PictureMaker {
 public:
  PictureMaker(const RunData& run, const std::function<bool()>& leave) : run_(run), leave_(leave) {}

  PictureSet make() {
    make_folder(run_.folder / "pictures");
    for (const DeclaredMetric& metric : run_.metrics)
      for (const MetricPicture& picture : metric.declaration.pictures) set_.fields.push_back({picture});
    try {
      read_states();
      draw_states();
      read_fields();
      for (FieldPictures& pictures : set_.fields) draw_fields(pictures);
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
        PairFields fields{std::move(*mesh), {}};
        try {
          for (VertexField& field : read_ply_fields(run_.folder / pair.fields))
            if (field.values.size() == fields.mesh.vertices.rows() && is_drawn(field.name))
              fields.values.insert_or_assign(field.name, std::move(field.values));
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

  bool is_drawn(const std::string& field) const {
    return std::any_of(set_.fields.begin(), set_.fields.end(), [&](const FieldPictures& f) {
      return field == f.declared.field || field == f.declared.other_field;
    });
  }

  void draw_fields(FieldPictures& pictures) {
    if (pictures.declared.kind == PictureKind::difference)
      draw_differences(pictures);
    else
      draw_thresholds(pictures);
  }

  /// The fields of a method's widest pair, if they have this one.
  const PairFields* widest_fields(const MethodRecord& method, const std::string& field) const {
    const ConsistencyRecord* pair = widest_pair(method);
    const PairFields* f = pair ? fields(method, pair->coarse, pair->fine) : nullptr;
    return f && f->find(field) ? f : nullptr;
  }

  void draw_differences(FieldPictures& pictures) {
    const std::string& field = pictures.declared.field;
    std::vector<const Eigen::VectorXd*> all;
    for (const MethodRecord& method : run_.methods)
      if (const PairFields* f = widest_fields(method, field)) all.push_back(f->find(field));
    pictures.scale = magnitude_quantile(all, difference_quantile);
    for (const MethodRecord& method : run_.methods) {
      const PairFields* f = widest_fields(method, field);
      if (!f) continue;
      const ConsistencyRecord& pair = *widest_pair(method);
      const Colours colours = diverging_colours(*f->find(field), pictures.scale);
      const auto rest = try_mesh("rest/l" + std::to_string(pair.fine) + ".ply");
      const std::string name = difference_picture(pictures.declared, method, pair);
      if (rest && rest->vertices.rows() == f->mesh.vertices.rows()) {
        pictures.on_rest = true;
        if (!map_renderer_) map_renderer_ = std::make_unique<Renderer>(map_size, map_size, leave_);
        keep(name, map_renderer_->draw({*rest, nullptr, &colours, false, false}, Camera::facing(*rest, 1)));
      } else {
        keep(name, renderer().draw({f->mesh, nullptr, &colours, false, true, obstacle()}, camera_));
      }
    }
  }

  /// A field of a method's finest state that has it.
  const Eigen::VectorXd* finest_field(const MethodRecord& method, const std::string& field) const {
    const Eigen::VectorXd* best = nullptr;
    int finest = -1;
    for (const ConsistencyRecord& pair : method.consistency) {
      const PairFields* f = fields(method, pair.coarse, pair.fine);
      if (f && f->find(field) && pair.fine > finest) {
        finest = pair.fine;
        best = f->find(field);
      }
    }
    return best;
  }

  void draw_thresholds(FieldPictures& pictures) {
    const Eigen::VectorXd* reference = nullptr;
    for (const MethodRecord& method : run_.methods)
      if (!reference) reference = finest_field(method, pictures.declared.field);
    if (!reference) return;
    pictures.scale = magnitude_quantile({reference}, threshold_quantile);
    for (const MethodRecord& method : run_.methods) {
      for (const LevelRecord& level : method.levels) {
        try {
          draw_threshold(pictures, method, level.level);
        } catch (const PictureLeft&) {
          throw;
        } catch (const std::exception& error) {
          set_.notes.push_back(threshold_picture(pictures.declared, method, level.level) + ": " +
                               reason_of(error));
        }
      }
    }
  }

  /// A coarse level's field is given on the finer mesh, so its state is split to that; the finest level has
  /// its own.
  void draw_threshold(const FieldPictures& pictures, const MethodRecord& method, int level) {
    const auto& [declared, threshold, on_rest] = pictures;
    const std::string name = threshold_picture(declared, method, level);
    for (auto pair = method.consistency.rbegin(); pair != method.consistency.rend(); ++pair) {
      const PairFields* f = fields(method, pair->coarse, pair->fine);
      const auto state = states_.find({method.name, level});
      if (!f || pair->coarse != level || !f->find(declared.other_field) || state == states_.end()) continue;
      TriangleMesh mesh = state->second;
      Positions normals = smooth_normals(mesh);
      const auto triangles = [this](Eigen::Index count) { return triangles_of(count); };
      if (!split_to(f->mesh.vertices.rows(), f->mesh.triangles, triangles, mesh, normals)) continue;
      const Colours colours = fold_colours(*f->find(declared.other_field), threshold);
      keep(name, renderer().draw({mesh, &normals, &colours, false, true, obstacle()}, camera_));
      return;
    }
    for (const ConsistencyRecord& pair : method.consistency) {
      const PairFields* f = fields(method, pair.coarse, pair.fine);
      if (!f || pair.fine != level || !f->find(declared.field)) continue;
      const Colours colours = fold_colours(*f->find(declared.field), threshold);
      keep(name, renderer().draw({f->mesh, nullptr, &colours, false, true, obstacle()}, camera_));
      return;
    }
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

std::string threshold_picture(const MetricPicture& picture, const MethodRecord& method, int level) {
  return file_part(method.name) + "_l" + std::to_string(level) + "_" + file_part(picture.name) + ".png";
}

std::string difference_picture(const MetricPicture& picture, const MethodRecord& method,
                               const ConsistencyRecord& pair) {
  return file_part(method.name) + "_l" + std::to_string(pair.coarse) + "_l" + std::to_string(pair.fine) +
         "_" + file_part(picture.name) + ".png";
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
