#include "core/app/report/report_view.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/app/files/csv.h"
#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/app/report/recorded_snapshots.h"
#include "core/app/view/view_document.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_snapshot_bytes = 4'000'000;  // of the whole page, uncompressed

/// Evenly chosen indices, at most `most`, beginning with the first. The last snapshot is the level's final
/// state, which is always shown.
std::vector<std::size_t> chosen_snapshots(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  if (count < 2) return chosen;
  const std::size_t shown = std::min(count - 1, most);
  for (std::size_t k = 0; k < shown; ++k) chosen.push_back(k * (count - 1) / shown);
  return chosen;
}

/// The fields that metrics of pairs declare pictures of.
std::vector<FieldKind> declared_fields(const RunData& run) {
  std::vector<FieldKind> kinds;
  for (const DeclaredMetric& metric : run.metrics)
    for (const MetricPicture& picture : metric.declaration.pictures) {
      const std::string label =
          picture.label + (picture.kind == PictureKind::difference ? " from the finest level" : "");
      kinds.push_back({picture.field, label, picture.unit, "diverging",
                       label + ", at the vertices that the finest level shares; known for last states only"});
    }
  return kinds;
}

class ReportViewMaker {
 public:
  explicit ReportViewMaker(const RunData& run)
      : run_(run),
        results_(parse_json(read_file(run.folder / "results.json"))),
        declared_(declared_fields(run)) {}

  ReportView make() {
    for (int l = 0; l <= run_.finest_level(); ++l) {
      TriangleMesh rest = read_mesh(run_.folder / "rest" / ("l" + std::to_string(l) + ".ply"));
      rest.grain = grain();
      levels_.push_back(Level::of(l, std::move(rest)));
    }
    for (const std::string& name : run_.obstacles) obstacles_.push_back(read_mesh(run_.folder / name));
    document_.emplace(
        levels_, obstacles_, run_.has_contact(),
        [this](const std::string& name, const std::string& bytes) { blocks_ += block_element(name, bytes); },
        declared_);
    read_states();
    if (states_.empty()) return {};
    Json methods = Json::array();
    for (std::size_t m = 0; m < run_.methods.size(); ++m) methods.push_back(method_entry(m));
    return {document_->document(run_.experiment, methods), blocks_, notes_};
  }

 private:
  struct State {
    Positions x;
    SurfaceFields fields;
  };

  std::optional<Grain> grain() const {
    ConfigErrors unread;
    const ConfigNode config = parse_yaml(run_.configuration, "config.yaml", unread);
    const ConfigNode* cloth = config.find("cloth");
    const ConfigNode *angle = cloth ? cloth->find("grain") : nullptr,
                     *along = cloth ? cloth->find("grain_along") : nullptr;
    const OptionalNumber degrees = angle ? number_of(angle->scalar) : std::nullopt;
    if (!degrees) return std::nullopt;
    return Grain{along && along->scalar == "u" ? Grain::Axis::u : Grain::Axis::x, *degrees};
  }

  void read_states() {
    std::vector<const SurfaceFields*> shown;
    for (std::size_t m = 0; m < run_.methods.size(); ++m)
      for (const LevelRecord& level : run_.methods[m].levels) {
        if (level.mesh.empty() || !std::filesystem::is_regular_file(run_.folder / level.mesh)) continue;
        State state;
        try {
          state.x = read_mesh(run_.folder / level.mesh).vertices;
          if (state.x.rows() != levels_[level.level].vertex_count()) continue;
          state.fields = document_->fields(level.level, state.x);
          add_declared(run_.methods[m], level.level, state);
        } catch (const std::exception&) {
          continue;  // the pictures name it
        }
        shown.push_back(&states_.insert_or_assign({m, level.level}, std::move(state)).first->second.fields);
      }
    document_->set_ranges(shown);
  }

  /// As they were recorded on the finest mesh, at the vertices that it shares with the coarse level: those
  /// come first. The finest level does not differ from itself.
  void add_declared(const MethodRecord& method, int level, State& state) const {
    const int finest = run_.finest_level();
    const bool is_finest = level == finest;
    const ConsistencyRecord* pair = nullptr;
    for (const ConsistencyRecord& each : method.consistency)
      if (each.fine == finest && (is_finest || each.coarse == level)) pair = &each;
    if (!pair || pair->fields.empty() || !std::filesystem::is_regular_file(run_.folder / pair->fields))
      return;
    const std::vector<VertexField> fields = read_ply_fields(run_.folder / pair->fields);
    for (const DeclaredMetric& metric : run_.metrics)
      for (const MetricPicture& picture : metric.declaration.pictures) {
        const bool difference = picture.kind == PictureKind::difference;
        if (difference && is_finest) {
          state.fields.emplace_back(picture.field, Eigen::VectorXd::Zero(state.x.rows()));
          continue;
        }
        const std::string& name = difference || is_finest ? picture.field : picture.other_field;
        for (const VertexField& field : fields)
          if (field.name == name && field.values.size() >= state.x.rows())
            state.fields.emplace_back(picture.field, field.values.head(state.x.rows()));
      }
  }

  /// The recorded snapshots; empty, with a note, if they cannot be read.
  Snapshots snapshots_of(const Json& level, Eigen::Index n) {
    try {
      return recorded_snapshots(run_.folder, level, n);
    } catch (const std::exception& error) {
      notes_.push_back("3D viewer: " + reason_of(error));
      return {};
    }
  }

  Json method_entry(std::size_t m) {
    const MethodRecord& method = run_.methods[m];
    Json levels = Json::array();
    // Finer levels may use the rest of a coarse level's share.
    std::size_t left = most_snapshot_bytes / run_.methods.size();
    for (std::size_t k = 0; k < method.levels.size(); ++k) {
      const LevelRecord& level = method.levels[k];
      const auto state = states_.find({m, level.level});
      if (state == states_.end()) continue;
      const std::string name = "m" + std::to_string(m) + "l" + std::to_string(level.level);
      Json states = Json::array();
      const Eigen::Index n = state->second.x.rows();
      const Snapshots snapshots = snapshots_of(results_.at("methods").at(method.name).at("levels").at(k), n);
      const std::size_t bytes = document_->state_bytes(level.level),
                        share = left / (method.levels.size() - k);
      for (const std::size_t f : chosen_snapshots(snapshots.states.count(), share / bytes)) {
        const Positions x = snapshots.states.positions(f);
        Json snapshot =
            document_->state(name + "f" + std::to_string(f), x, document_->fields(level.level, x));
        snapshot["iteration"] = snapshots.iterations[f];
        snapshot["seconds"] = snapshots.seconds[f];
        states.push_back(snapshot);
        left -= bytes;
      }
      Json last = document_->state(name, state->second.x, state->second.fields);
      last["iteration"] = level.iterations ? Json(*level.iterations) : Json();
      states.push_back(last);
      levels.push_back({{"level", level.level}, {"status", level.status}, {"states", states}});
    }
    return {{"name", method.name}, {"levels", levels}};
  }

  const RunData& run_;
  const Json results_;
  const std::vector<FieldKind> declared_;
  std::vector<Level> levels_;
  std::vector<TriangleMesh> obstacles_;
  std::optional<ViewDocument> document_;
  std::map<std::pair<std::size_t, int>, State> states_;  // by number of the method, and level
  std::string blocks_;
  std::vector<std::string> notes_;
};

}  // namespace

ReportView report_view(const RunData& run) {
  if (run.finest_level() < 0) return {};
  try {
    return ReportViewMaker(run).make();
  } catch (const std::exception& error) {
    return {nullptr, "", {"3D viewer: " + reason_of(error)}};
  }
}

}  // namespace drape
