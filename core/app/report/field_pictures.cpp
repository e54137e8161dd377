#include "core/app/report/field_pictures.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/picture/surface.h"
#include "core/app/report/midpoint_surface.h"
#include "core/app/view/colours.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace {

/// The fine state of a pair with the fields of its metrics.
struct PairFields {
  TriangleMesh mesh;
  std::map<std::string, Eigen::VectorXd> values;  // one for each vertex

  const Eigen::VectorXd* find(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? nullptr : &found->second;
  }
};

class FieldPictureMaker {
 public:
  FieldPictureMaker(const RunData& run, PictureCanvas& canvas, PictureSet& set)
      : run_(run), canvas_(canvas), set_(set) {}

  void make() {
    read_fields();
    for (FieldPictures& pictures : set_.fields)
      if (pictures.declared.kind == PictureKind::difference)
        draw_differences(pictures);
      else
        draw_thresholds(pictures);
  }

 private:
  void read_fields() {
    for (const MethodRecord& method : run_.methods) {
      for (const ConsistencyRecord& pair : method.consistency) {
        auto mesh = canvas_.try_mesh(pair.fields);
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
      const auto rest = canvas_.try_mesh("rest/l" + std::to_string(pair.fine) + ".ply");
      const std::string name = difference_picture(pictures.declared, method, pair);
      if (rest && rest->vertices.rows() == f->mesh.vertices.rows()) {
        pictures.on_rest = true;
        canvas_.draw_map(name, *rest, colours);
      } else {
        canvas_.draw(name, {f->mesh, nullptr, &colours});
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
        } catch (const RenderingCancelled&) {
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
      const TriangleMesh* state = canvas_.scene().state(method.name, level);
      if (!f || pair->coarse != level || !f->find(declared.other_field) || !state) continue;
      TriangleMesh mesh = *state;
      Positions normals = smooth_normals(mesh);
      const auto triangles = [this](Eigen::Index count) { return canvas_.scene().triangles_of(count); };
      if (!split_to(f->mesh.vertices.rows(), f->mesh.triangles, triangles, mesh, normals)) continue;
      const Colours colours = fold_colours(*f->find(declared.other_field), threshold);
      canvas_.draw(name, {mesh, &normals, &colours});
      return;
    }
    for (const ConsistencyRecord& pair : method.consistency) {
      const PairFields* f = fields(method, pair.coarse, pair.fine);
      if (!f || pair.fine != level || !f->find(declared.field)) continue;
      const Colours colours = fold_colours(*f->find(declared.field), threshold);
      canvas_.draw(name, {f->mesh, nullptr, &colours});
      return;
    }
  }

  const RunData& run_;
  PictureCanvas& canvas_;
  PictureSet& set_;
  std::map<std::pair<std::string, std::pair<int, int>>, PairFields> fields_;  // by method, and pair of levels
};

}  // namespace

void draw_fields(const RunData& run, PictureCanvas& canvas, PictureSet& set) {
  FieldPictureMaker(run, canvas, set).make();
}

}  // namespace drape
