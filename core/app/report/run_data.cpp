#include "core/app/report/run_data.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "core/app/experiment/experiment.h"
#include "core/app/files/csv.h"
#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/app/report/undeclared_metrics.h"
#include "core/kernel/mesh/file.h"
#include "core/kernel/mesh/message_text.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* remedy = "run the experiment again";

const Json& at(const Json& json, const char* key) {
  static const Json absent;
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() ? *found : absent;
}

OptionalNumber number(const Json& json) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) return {};
  return json.get<double>();
}

std::string text(const Json& json) { return json.is_string() ? json.get<std::string>() : std::string(); }

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
    values.set(column.name, number(at(json, column.name.c_str())));
  return values;
}

LevelRecord level_record(const JsonFile& file, const Metrics& metrics, const Json& json, int position) {
  LevelRecord r;
  r.level = file.find<int>(json, "level").value_or(position);
  r.status = text(at(json, "status"));
  r.message = text(at(json, "message"));
  r.vertices = number(at(json, "vertices"));
  r.triangles = number(at(json, "triangles"));
  r.steps = number(at(json, "steps"));
  r.newton_iterations = number(at(json, "newton_iterations"));
  r.flops = number(at(json, "flops"));
  r.from_initial_state =
      at(json, "from_initial_state").is_boolean() && at(json, "from_initial_state").get<bool>();
  r.seconds = number(at(json, "seconds"));
  r.energy = number(at(json, "energy"));
  r.energy_on_finest = number(at(json, "energy_on_finest"));
  r.decrement = number(at(json, "decrement"));
  r.force_residual = number(at(json, "force_residual"));
  r.intersections = number(at(json, "intersections"));
  r.smallest_gap = number(at(json, "smallest_gap"));
  r.seconds_by_phase = named_numbers(at(json, "seconds_by_phase"));
  r.energy_parts = named_numbers(at(json, "energy_parts"));
  r.metrics = metric_values(json, metrics, MetricScope::state);
  r.mesh = text(at(json, "mesh"));
  return r;
}

ConsistencyRecord consistency_record(const JsonFile& file, const Metrics& metrics, const Json& json) {
  ConsistencyRecord r;
  r.coarse = file.find<int>(json, "coarse").value_or(-1);
  r.fine = file.find<int>(json, "fine").value_or(-1);
  r.metrics = metric_values(json, metrics, MetricScope::pair);
  r.of_start = metric_values(at(json, "of_start"), metrics, MetricScope::pair);
  r.fields = text(at(json, "fields"));
  return r;
}

MethodRecord method_record(const JsonFile& file, const Metrics& metrics, const std::string& name,
                           const Json& json) {
  MethodRecord method;
  method.name = name;
  method.status = text(at(json, "status"));
  method.seconds = number(at(json, "seconds"));
  method.peak_memory_bytes = number(at(json, "peak_memory_bytes"));
  const Json& levels = at(json, "levels");
  const Json& pairs = at(json, "consistency");
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

IncrementRecord increment_record(const Json& json) {
  return {number(at(json, "time")), number(at(json, "steps")), number(at(json, "energy"))};
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

std::vector<IterationSeries> read_steps(const std::filesystem::path& path) {
  std::vector<IterationSeries> all;
  const Csv csv(path);
  if (!csv.has("method") || !csv.has("level")) return all;
  for (std::size_t k = 0; k < csv.size(); ++k) {
    const auto cell = [&](const char* name) { return csv.number(k, name); };
    series_of(all, csv.text(k, "method"), level_of(csv, k, path))
        .rows.push_back({cell("seconds"), cell("energy"), cell("decrement"), cell("force_residual"),
                         cell("step_length"), cell("proxy_energy"), cell("step_size"), cell("contacts"),
                         cell("smallest_gap"), cell("intersections")});
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

std::vector<IncrementSeries> increments_of(const JsonFile& file, const std::string& method,
                                           const Json& increments) {
  std::vector<IncrementSeries> all;
  if (!increments.is_array()) return all;
  for (const Json& increment : increments)
    series_of(all, method, file.find<int>(increment, "level").value_or(0))
        .rows.push_back(increment_record(increment));
  return all;
}

void add_last_contacts(RunData& run) {
  for (const IterationSeries& series : run.iterations)
    for (MethodRecord& method : run.methods)
      for (LevelRecord& level : method.levels)
        if (method.name == series.method && level.level == series.level)
          level.contacts = series.rows.back().contacts;
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

const LevelRecord* MethodRecord::level(int index) const {
  for (const LevelRecord& r : levels) {
    if (r.level == index) return &r;
  }
  return nullptr;
}

const ConsistencyRecord* MethodRecord::pair(int coarse, int fine) const {
  for (const ConsistencyRecord& r : consistency) {
    if (r.coarse == coarse && r.fine == fine) return &r;
  }
  return nullptr;
}

OptionalNumber MethodRecord::cost(OptionalNumber LevelRecord::*member) const {
  OptionalNumber sum;
  for (const LevelRecord& level : levels) {
    if (level.from_initial_state) sum.reset();
    if (level.*member) sum = sum.value_or(0) + *(level.*member);
  }
  return sum;
}

bool RunData::has_contact() const {
  for (const MethodRecord& m : methods) {
    for (const LevelRecord& r : m.levels) {
      if (r.intersections || r.smallest_gap) return true;
    }
  }
  return false;
}

int RunData::coarsest_level() const {
  const std::vector<int> all = level_indices();
  return all.empty() ? -1 : all.front();
}

int RunData::finest_level() const {
  const std::vector<int> all = level_indices();
  return all.empty() ? -1 : all.back();
}

std::vector<int> RunData::level_indices() const {
  std::set<int> all;
  for (const MethodRecord& m : methods) {
    for (const LevelRecord& r : m.levels) all.insert(r.level);
  }
  return {all.begin(), all.end()};
}

std::vector<std::pair<int, int>> RunData::pairs() const {
  std::set<std::pair<int, int>> all;
  for (const MethodRecord& m : methods) {
    for (const ConsistencyRecord& r : m.consistency) all.emplace(r.coarse, r.fine);
  }
  return {all.begin(), all.end()};
}

RunData read_run(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "results.json";
  if (!std::filesystem::is_regular_file(path)) {
    throw std::runtime_error(folder.string() + ": no results.json here; give the folder of a run");
  }
  const Json json = Json::parse(read_file(path), nullptr, false);
  if (!json.is_object()) throw std::runtime_error(path.string() + ": not a JSON object; is it cut short?");

  const JsonFile file(path, remedy);
  RunData run;
  run.folder = folder;
  run.experiment = text(at(json, "experiment"));
  run.description = text(at(json, "description"));
  run.version = text(at(json, "version"));
  if (const Json& obstacles = at(json, "obstacles"); obstacles.is_array())
    for (const Json& name : obstacles) run.obstacles.push_back(text(name));
  run.complete = at(json, "complete").is_boolean() && at(json, "complete").get<bool>();
  run.aborted = text(at(json, "aborted"));
  const Json& machine = at(json, "machine");
  run.cpu = text(at(machine, "cpu"));
  run.cores = number(at(machine, "cores"));
  run.threads = number(at(machine, "threads"));
  const Json& reference = at(json, "reference");
  for (const char* key : {"method", "file"})
    if (!text(at(reference, key)).empty()) run.reference = text(at(reference, key));
  run.reference_is_lowest = text(at(reference, "chosen")) == ReferenceParameters::lowest;
  run.reference_tolerance = number(at(reference, "force_tolerance"));
  run.force_tolerance = number(at(at(json, "tolerance"), "force_residual"));
  const Json& methods = at(json, "methods");
  const Json& declared = at(json, "metrics");
  run.metrics = declared.is_object() ? declared_metrics(declared) : undeclared_metrics(methods);
  run.error_measures =
      declared.is_object() ? error_measures(run.metrics) : undeclared_errors(Csv(folder / "errors.csv"));
  if (methods.is_object()) {
    for (const auto& [name, value] : methods.items()) {
      run.methods.push_back(method_record(file, run.metrics, name, value));
      const std::vector<IncrementSeries> increments = increments_of(file, name, at(value, "increments"));
      run.increments.insert(run.increments.end(), increments.begin(), increments.end());
    }
  }
  // The progressive method comes first; the others stay in file order.
  std::stable_partition(run.methods.begin(), run.methods.end(),
                        [](const MethodRecord& m) { return m.name == "pcs"; });
  run.iterations = read_steps(folder / "steps.csv");
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
  std::stable_sort(run.increments.begin(), run.increments.end(),
                   [&](const IncrementSeries& a, const IncrementSeries& b) { return place(a) < place(b); });
  run.configuration = file_if_there(folder / "config.yaml");
  add_last_contacts(run);
  add_step_sizes(run);
  return run;
}

}  // namespace drape
