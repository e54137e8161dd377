// The recorder's job at the end of a method: metrics of its levels and of pairs of them.

#include <algorithm>
#include <optional>

#include "core/app/experiment/exit_codes.h"
#include "core/app/run/recorder.h"
#include "core/app/run/recorder_files.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace {

/// The member of an object with a dotted name: "a.b" is member b of member a.
Json& at_dotted(Json& object, const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? object[name]
                                  : at_dotted(object[name.substr(0, dot)], name.substr(dot + 1));
}

bool is_in_tables(const Metric& metric) {
  return std::ranges::any_of(metric.declaration().columns,
                             [](const MetricColumn& column) { return column.shown != Shown::stored; });
}

/// "fields/pcs_l0_l2.ply"
std::string fields_file(const std::string& method, int coarse, int fine) {
  return "fields/" + method + "_l" + std::to_string(coarse) + "_l" + std::to_string(fine) + ".ply";
}

}  // namespace

Positions Recorder::prolonged(const std::string& method, const Positions& x, int from, int to) const {
  const Interpolation interpolation = experiment_.solver_of(method).interpolation();
  return scene_.hierarchy.prolong(x, from, to, scene_.hierarchy.weights(interpolation));
}

double Recorder::energy_on_finest(int level, const Positions& x) const {
  return scene_.finest_model().value(prolonged(s_.method, x, level, scene_.finest()));
}

MetricResult Recorder::measure(const std::string& name, const Metric& metric, const MetricInput& input,
                               Json& entry) {
  std::string cause;
  try {
    return metric.evaluate(input);
  } catch (...) {
    cause = message_in_flight();
  }
  not_measured_.emplace(name, cause);
  entry["not_measured"][name] = cause;
  log("not_measured", {{"method", s_.method}, {"metric", name}, {"message", cause}});
  return {};
}

Json Recorder::compare(int level, const Positions& x, const Positions& other, VertexFields* fields) {
  Json row = Json::object();  // not null, even without a metric of pairs
  for (const auto& [name, metric] : experiment_.metrics) {
    if (metric->scope() != MetricScope::pair) continue;
    const MetricResult result =
        measure(name, *metric, {scene_.hierarchy.levels[level], *scene_.model(level), x, &other}, row);
    for (const MetricValue& v : result.values) at_dotted(row, v.name) = v.value;
    if (fields) fields->insert(fields->end(), result.fields.begin(), result.fields.end());
  }
  return row;
}

Json Recorder::pair_entry(const RecordedState& coarse, const RecordedState& fine) {
  const Positions x = prolonged(fine.method, coarse.x, coarse.level, fine.level);
  Json row = {{"coarse", coarse.level}, {"fine", fine.level}};
  VertexFields fields;
  row.update(compare(fine.level, fine.x, x, &fields));
  if (fine.level != scene_.finest() || fields.empty()) return row;
  const std::string file = fields_file(fine.method, coarse.level, fine.level),
                    bytes = ply_bytes({fine.x, scene_.hierarchy.levels[fine.level].rest.triangles}, fields);
  write_file(folder_.file(file), bytes);
  row["fields"] = file;
  row["fields_checksum"] = checksum_of(bytes);
  return row;
}

void Recorder::measure_pairs(const std::vector<LevelResult>& results) {
  Json& consistency = method_entry()["consistency"];
  std::vector<Json> of_start;  // the start compared with each level's state
  for (const LevelResult& r : results)
    of_start.push_back(&r == &results.front() ? Json() : compare(r.level, r.x, scene_.starts[r.level]));
  for (std::size_t c = 0; c < results.size(); ++c)
    for (std::size_t f = c + 1; f < results.size(); ++f) {  // a method may skip levels
      consistency.push_back(pair_entry({s_.method, results[c].level, results[c].x},
                                       {s_.method, results[f].level, results[f].x}));
      consistency.back()["of_start"] = of_start[f];
    }
}

void Recorder::method_finished(const std::vector<LevelResult>& results,
                               const std::optional<MethodFailure>& failure, bool all) {
  Json& entry = method_entry();
  // A level that failed during recording may have left an entry.
  while (entry["levels"].size() > results.size()) entry["levels"].erase(entry["levels"].size() - 1);
  Outcome worst = Outcome::converged;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const LevelResult& r = results[i];
    worst = std::max(worst, r.outcome);
    Json& state = entry["levels"][i];
    const LevelModel model = scene_.model(r.level)->with_stiffness(r.contact_stiffness);
    for (const auto& [name, metric] : experiment_.metrics)
      if (metric->scope() == MetricScope::state && (all || is_in_tables(*metric)))
        for (const MetricValue& v :
             measure(name, *metric, {scene_.hierarchy.levels[r.level], model, r.x}, state).values)
          at_dotted(state, v.name) = v.value;
  }
  write_collection(s_.method);
  if (all) measure_pairs(results);
  if (!s_.intersection_free) worst = Outcome::infeasible;
  entry["status"] = failure ? failed : to_string(worst);
  if (failure) {
    const Level& level = scene_.hierarchy.levels[failure->level];
    entry["levels"].push_back({{"level", failure->level},
                               {"vertices", level.vertex_count()},
                               {"triangles", level.triangle_count()},
                               {"status", failed},
                               {"message", failure->cause}});
    log("method_failed", {{"method", s_.method}, {"level", failure->level}, {"message", failure->cause}});
  }
  save();
  log("method_finished", {{"method", s_.method}, {"status", entry["status"]}});
}

bool Recorder::all_converged() const {
  const Json& methods = results_.at("methods");
  return std::all_of(methods.begin(), methods.end(), [](const Json& method) {
    return has_converged(method.at("status").get<std::string>());
  });
}

void Recorder::restore_fields() {
  const std::string current = s_.method;
  for (const RecordedState* fine : finest_states())
    for (const RecordedState& coarse : s_.states) {
      if (coarse.method != fine->method || coarse.level >= fine->level) continue;
      const std::string name = fields_file(fine->method, coarse.level, fine->level);
      const std::filesystem::path file = folder_.file(name);
      for (const Json& row : results_["methods"][fine->method]["consistency"]) {
        if (row.value("fields", "") != name ||
            (std::filesystem::is_regular_file(file) &&
             checksum_of(read_file(file)) == row.value("fields_checksum", 0u)))
          continue;
        s_.method = fine->method;  // whose metrics these are
        pair_entry(coarse, *fine);
        written_.push_back(name);
      }
    }
  s_.method = current;
}

}  // namespace drape
