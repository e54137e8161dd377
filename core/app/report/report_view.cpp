#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/app/report/report.h"
#include "core/app/view/page.h"
#include "core/app/view/view_document.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace {

constexpr std::size_t most_snapshot_bytes = 4'000'000;  // of the whole page, uncompressed

struct State {
  Positions x;
  SurfaceFields fields;
};
using States = std::map<const LevelRecord*, State>;  // the final state of each level that can be shown

/// The fields that metrics of pairs declare colours of.
std::vector<FieldKind> declared_fields(const RunData& run) {
  std::vector<FieldKind> kinds;
  for (const DeclaredMetric& metric : run.metrics)
    for (const MetricColours& colours : metric.declaration.colours) {
      const std::string label = colours.label + (colours.other_field.empty() ? " from the finest level" : "");
      kinds.push_back({colours.field, label, colours.unit, "diverging",
                       label + ", at the vertices that the finest level shares; known for last states only"});
    }
  return kinds;
}

/// As they were recorded on the finest mesh, at the vertices that it shares with the coarse level: those
/// come first. The finest level does not differ from itself.
void add_declared(const RunData& run, const MethodRecord& method, int level, State& state) {
  const int finest = run.finest_level();
  const bool is_finest = level == finest;
  const ConsistencyRecord* pair = nullptr;
  for (const ConsistencyRecord& each : method.consistency)
    if (each.fine == finest && (is_finest || each.coarse == level)) pair = &each;
  if (!pair || !pair->fields.exists()) return;
  const VertexFields fields = pair->fields.fields();
  for (const DeclaredMetric& metric : run.metrics)
    for (const MetricColours& colours : metric.declaration.colours) {
      const bool difference = colours.other_field.empty();
      const std::string& name = difference || is_finest ? colours.field : colours.other_field;
      if (difference && is_finest)
        state.fields.emplace(colours.field, Eigen::VectorXd::Zero(state.x.rows()));
      else
        for (const VertexField& field : fields)
          if (field.name == name && field.values.size() >= state.x.rows())
            state.fields.emplace(colours.field, field.values.head(state.x.rows()));
    }
}

States read_states(const RunData& run, const std::vector<Level>& levels, const ViewDocument& document,
                   std::vector<std::string>& notes) {
  States states;
  for (const MethodRecord& method : run.methods)
    for (const LevelRecord& level : method.levels) {
      if (!level.mesh.exists()) continue;
      try {
        State state{level.mesh.mesh().vertices, {}};
        if (state.x.rows() != levels[level.level].vertex_count()) continue;
        Eigen::VectorXd pressure;
        for (VertexField& field : level.mesh.fields())
          if (field.name == "contact_pressure") pressure = std::move(field.values);
        state.fields = document.fields(level.level, state.x, pressure);
        try {
          add_declared(run, method, level.level, state);
        } catch (const std::exception& damaged) {
          add_new(notes, "3D viewer: " + reason_of(damaged));
        }
        states.emplace(&level, std::move(state));
      } catch (const std::exception& damaged) {
        add_new(notes, reason_of(damaged));  // as the pictures name it
      }
    }
  return states;
}

/// A level's evenly chosen snapshots, at most `bytes` of them, and its final state.
Json states_json(const RunData& run, const LevelRecord& level, const State& last, const std::string& name,
                 std::size_t bytes, ViewDocument& document, std::vector<std::string>& notes) {
  Json states = Json::array();
  SnapshotFile snapshots;
  try {
    snapshots = run.snapshots(level, last.x.rows());
  } catch (const std::exception& error) {
    add_new(notes, "3D viewer: " + reason_of(error));
  }
  const std::size_t bytes_of_state = last.x.rows() * (6 + last.fields.size());
  const std::size_t count = snapshots.count() > 0 ? snapshots.count() - 1 : 0,
                    shown = std::min(count, bytes / bytes_of_state);
  for (std::size_t k = 0; k < shown; ++k) {
    const std::size_t f = k * count / shown;
    const Positions x = snapshots.positions(f);
    Json& state = states.emplace_back(
        document.state(name + "f" + std::to_string(f), x, document.fields(level.level, x)));
    state["iteration"] = level.snapshots()["iterations"][f];
    state["seconds"] = level.snapshots()["seconds"][f];
  }
  Json& state = states.emplace_back(document.state(name, last.x, last.fields));
  if (const auto iterations = number_member(level.values, "iterations")) state["iteration"] = *iterations;
  return states;
}

ReportView view_of(const RunData& run, std::vector<std::string>& notes) {
  ReportView view;
  std::vector<Level> levels;
  for (int l = 0; l <= run.finest_level(); ++l) levels.push_back(Level::of(l, run.rest(l).mesh()));
  std::vector<TriangleMesh> obstacles;
  for (const ObstacleRecord& obstacle : run.obstacles) obstacles.push_back(obstacle.mesh.mesh());
  ViewDocument document(levels, obstacles, run.has_contact(), embedded_in(view.blocks), declared_fields(run));
  const States states = read_states(run, levels, document, notes);
  if (states.empty()) return {};
  std::vector<const SurfaceFields*> fields;
  for (const auto& [level, state] : states) fields.push_back(&state.fields);
  document.set_ranges(fields);
  Json methods = Json::array();
  for (std::size_t m = 0; m < run.methods.size(); ++m) {
    Json entries = Json::array();
    for (const LevelRecord& level : run.methods[m].levels) {
      const auto state = states.find(&level);
      if (state == states.end()) continue;
      const std::string name = "m" + std::to_string(m) + "l" + std::to_string(level.level);
      entries.push_back({{"level", level.level},
                         {"status", level.status},
                         {"states", states_json(run, level, state->second, name,
                                                most_snapshot_bytes / states.size(), document, notes)}});
    }
    methods.push_back({{"name", run.methods[m].name}, {"levels", entries}});
  }
  view.document = document.document(run.experiment, methods);
  return view;
}

}  // namespace

ReportView report_view(const RunData& run, std::vector<std::string>& notes) {
  try {
    if (run.finest_level() >= 0) return view_of(run, notes);
  } catch (const std::exception& error) {
    add_new(notes, "3D viewer: " + reason_of(error));
  }
  return {};
}

std::string viewer_page(const RunData& run) {
  std::vector<std::string> notes;
  const ReportView view = report_view(run, notes);
  if (view.document.is_null())
    throw std::runtime_error(notes.empty() ? run.folder.string() + ": the run has no state to show"
                                           : notes.front());
  return page(run.experiment, {{"kind", "states"}, {"view", view.document}, {"notes", notes}}, view.blocks);
}

std::string viewer_page(const std::string& title, const Level& level, const Positions& x,
                        const std::vector<TriangleMesh>& obstacles, const Eigen::VectorXd& pressure) {
  std::vector<Level> levels = {level};
  levels.front().index = 0;  // the only one of its document
  std::string blocks;
  ViewDocument document(levels, obstacles, pressure.size() > 0, embedded_in(blocks));
  const SurfaceFields fields = document.fields(0, x, pressure);
  document.set_ranges({&fields});
  const Json entry = {
      {"level", 0}, {"status", ""}, {"states", Json::array({document.state("state", x, fields)})}};
  const Json method = {{"name", title}, {"levels", Json::array({entry})}};
  return page(title, {{"kind", "states"}, {"view", document.document(title, Json::array({method}))}}, blocks);
}

}  // namespace drape
