#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/app/files/csv.h"
#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/app/report/run_data.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* remedy = "run the experiment again";

OptionalNumber number(const Json& json) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) return {};
  return json.get<double>();
}

/// The texts of a list, empty where it has something else.
std::vector<std::string> texts(const Json& json) {
  std::vector<std::string> all;
  if (!json.is_array()) return all;
  for (const Json& text : json) all.push_back(text.is_string() ? text.get<std::string>() : std::string());
  return all;
}

NamedNumbers named_numbers(const Json& json) {
  NamedNumbers numbers;
  if (!json.is_object()) return numbers;
  for (const auto& [name, value] : json.items()) numbers.emplace_back(name, number(value));
  return numbers;
}

using Metrics = std::vector<DeclaredMetric>;

Values metric_values(const Json& json, const Metrics& metrics, MetricScope scope) {
  Values values;
  for (const MetricColumn& column : columns_of(metrics, scope, Shown::stored))
    values.set(column.name, number(member_of(json, column.name)));
  return values;
}

LevelRecord level_record(const JsonFile& file, const Metrics& metrics, const Json& json, int position) {
  LevelRecord r;
  r.level = file.find<int>(json, "level").value_or(position);
  r.status = text_member(json, "status");
  r.message = text_member(json, "message");
  for (const LevelQuantity& quantity : level_quantities)
    r.*quantity.member = number(member_of(json, quantity.name));
  r.from_initial_state =
      member_of(json, "from_initial_state").is_boolean() && member_of(json, "from_initial_state").get<bool>();
  r.seconds_by_phase = named_numbers(member_of(json, "seconds_by_phase"));
  r.energy_parts = named_numbers(member_of(json, "energy_parts"));
  r.metrics = metric_values(json, metrics, MetricScope::state);
  r.mesh = text_member(json, "mesh");
  return r;
}

ConsistencyRecord consistency_record(const JsonFile& file, const Metrics& metrics, const Json& json) {
  ConsistencyRecord r;
  r.coarse = file.find<int>(json, "coarse").value_or(-1);
  r.fine = file.find<int>(json, "fine").value_or(-1);
  r.metrics = metric_values(json, metrics, MetricScope::pair);
  r.of_start = metric_values(member_of(json, "of_start"), metrics, MetricScope::pair);
  r.fields = text_member(json, "fields");
  return r;
}

MethodRecord method_record(const JsonFile& file, const Metrics& metrics, const std::string& name,
                           const Json& json) {
  MethodRecord method;
  method.name = name;
  method.status = text_member(json, "status");
  method.solver = text_member(json, "solver");
  method.seconds = number(member_of(json, "seconds"));
  method.peak_memory_bytes = number(member_of(json, "peak_memory_bytes"));
  const Json& levels = member_of(json, "levels");
  const Json& pairs = member_of(json, "consistency");
  if (levels.is_array()) {
    for (const Json& level : levels) {
      if (level.is_object())
        method.levels.push_back(level_record(file, metrics, level, int(method.levels.size())));
    }
  }
  if (pairs.is_array()) {
    for (const Json& pair : pairs) {
      const ConsistencyRecord record = consistency_record(file, metrics, pair);
      if (record.coarse >= 0 && record.fine > record.coarse) method.consistency.push_back(record);
    }
  }
  std::stable_sort(method.levels.begin(), method.levels.end(),
                   [](const LevelRecord& a, const LevelRecord& b) { return a.level < b.level; });
  return method;
}

std::string file_if_there(const std::filesystem::path& path) {
  return std::filesystem::is_regular_file(path) ? read_file(path) : std::string();
}

/// The level of a row; the coarsest if the cell is empty.
int level_of(const Csv& csv, std::size_t row, const std::filesystem::path& path) {
  const double level = csv.number(row, "level").value_or(0);
  if (const std::optional<int> whole = whole_number(level)) return *whole;
  throw std::runtime_error(path.string() + ": \"level\" of row " + std::to_string(row + 1) +
                           " must be a whole number, not " + excerpt(csv.text(row, "level")) + "; " + remedy);
}

/// The rows of one level of one method; added if new.
template <class Series>
Series& series_of(std::vector<Series>& all, const std::string& method, int level) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Series& s) { return s.method == method && s.level == level; });
  if (found != all.end()) return *found;
  return *all.insert(all.end(), {method, level, {}});
}

void set_cell(int& value, const OptionalNumber& cell) { value = whole_number(cell.value_or(0)).value_or(0); }
void set_cell(double& value, const OptionalNumber& cell) {
  value = cell.value_or(std::numeric_limits<double>::quiet_NaN());
}
template <class Number>
void set_cell(std::optional<Number>& value, const OptionalNumber& cell) {
  if (cell) set_cell(value.emplace(), cell);
}

std::vector<IterationSeries> read_iterations(const std::filesystem::path& path) {
  std::vector<IterationSeries> all;
  const Csv csv(path);
  if (!csv.has("method") || !csv.has("level")) return all;
  for (std::size_t k = 0; k < csv.size(); ++k) {
    RecordedIteration& row =
        series_of(all, csv.text(k, "method"), level_of(csv, k, path)).rows.emplace_back();
    for_each_column(row, [&](const char* name, auto& value, int) { set_cell(value, csv.number(k, name)); });
  }
  return all;
}

std::vector<ErrorSeries> read_errors(const std::filesystem::path& path,
                                     const std::vector<ErrorMeasure>& measures) {
  std::vector<ErrorSeries> all;
  const Csv csv(path);
  if (!csv.has("method") || !csv.has("level")) return all;
  for (std::size_t k = 0; k < csv.size(); ++k) {
    ErrorRow row;
    for (std::size_t w = 0; w < error_costs.size(); ++w) row.cost[w] = csv.number(k, error_costs[w]);
    for (std::size_t t = 0; t < error_targets.size(); ++t)
      for (const ErrorMeasure& measure : measures)
        row.error[t].set(measure.name, csv.number(k, std::string(error_targets[t]) + "_" + measure.name));
    series_of(all, csv.text(k, "method"), level_of(csv, k, path)).rows.push_back(row);
  }
  return all;
}

void add_step_sizes(RunData& run) {
  ConfigErrors unread;
  const ConfigNode config = parse_yaml(run.configuration, "config.yaml", unread);
  for (MethodRecord& method : run.methods) {
    const ConfigNode* node = config.find("methods");
    for (const char* key : {method.name.c_str(), "newton", "step_size"}) node = node ? node->find(key) : node;
    if (node) method.step_size = number_of(node->scalar);
  }
}

}  // namespace

RunData read_run(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "results.json";
  if (!std::filesystem::is_regular_file(path)) {
    throw std::runtime_error(folder.string() + ": no results.json here; give the folder of a run");
  }
  const Json json = parse_json(read_file(path));
  if (!json.is_object()) throw std::runtime_error(path.string() + ": not a JSON object; is it cut short?");

  const JsonFile file(path, remedy);
  RunData run;
  run.folder = folder;
  run.experiment = text_member(json, "experiment");
  run.version = text_member(json, "version");
  run.obstacles = texts(member_of(json, "obstacles"));
  run.obstacle_names = texts(member_of(json, "obstacle_names"));
  run.obstacle_names.resize(run.obstacles.size());
  run.complete = member_of(json, "complete").is_boolean() && member_of(json, "complete").get<bool>();
  const Json& machine = member_of(json, "machine");
  run.cpu = text_member(machine, "cpu");
  run.threads = number(member_of(machine, "threads"));
  const Json& reference = member_of(json, "reference");
  for (const char* key : {"method", "file"})
    if (!text_member(reference, key).empty()) run.reference = text_member(reference, key);
  run.reference_is_file = !text_member(reference, "file").empty();
  const Json& methods = member_of(json, "methods");
  run.metrics = declared_metrics(member_of(json, "metrics"));
  run.error_measures = error_measures(run.metrics);
  if (methods.is_object()) {
    for (const auto& [name, value] : methods.items())
      run.methods.push_back(method_record(file, run.metrics, name, value));
  }
  // The progressive method comes first; the others stay in file order.
  std::stable_partition(run.methods.begin(), run.methods.end(),
                        [](const MethodRecord& m) { return m.name == "pcs"; });
  run.iterations = read_iterations(folder / "iterations.csv");
  const auto place = [&run](const auto& s) {
    const auto method = std::find_if(run.methods.begin(), run.methods.end(),
                                     [&](const MethodRecord& m) { return m.name == s.method; });
    return std::pair(method - run.methods.begin(), s.level);
  };
  std::stable_sort(run.iterations.begin(), run.iterations.end(),
                   [&](const IterationSeries& a, const IterationSeries& b) { return place(a) < place(b); });
  run.errors = read_errors(folder / "errors.csv", run.error_measures);
  std::stable_sort(run.errors.begin(), run.errors.end(),
                   [&](const ErrorSeries& a, const ErrorSeries& b) { return place(a) < place(b); });
  run.configuration = file_if_there(folder / "config.yaml");
  add_step_sizes(run);
  return run;
}

}  // namespace drape
