#include "core/report/run_data.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "core/experiment/yaml_file.h"
#include "core/mesh/file.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

const Json& at(const Json& json, const char* key) {
  static const Json absent;
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() ? *found : absent;
}

Figure figure(const Json& json) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) return {};
  return json.get<double>();
}

std::string text(const Json& json) { return json.is_string() ? json.get<std::string>() : std::string(); }

NamedFigures named_figures(const Json& json) {
  NamedFigures figures;
  if (!json.is_object()) return figures;
  for (const auto& [name, value] : json.items()) figures.emplace_back(name, figure(value));
  return figures;
}

LevelRecord level_record(const Json& json, int position) {
  LevelRecord r;
  r.level = static_cast<int>(figure(at(json, "level")).value_or(position));
  r.status = text(at(json, "status"));
  r.message = text(at(json, "message"));
  r.vertices = figure(at(json, "vertices"));
  r.triangles = figure(at(json, "triangles"));
  r.steps = figure(at(json, "steps"));
  r.newton_iterations = figure(at(json, "newton_iterations"));
  r.seconds = figure(at(json, "seconds"));
  r.energy = figure(at(json, "energy"));
  r.energy_on_finest = figure(at(json, "energy_on_finest"));
  r.decrement = figure(at(json, "decrement"));
  r.force_residual = figure(at(json, "force_residual"));
  r.largest_stretch = figure(at(json, "largest_stretch"));
  r.intersections = figure(at(json, "intersections"));
  r.smallest_gap = figure(at(json, "smallest_gap"));
  r.seconds_by_phase = named_figures(at(json, "seconds_by_phase"));
  r.energy_parts = named_figures(at(json, "energy_parts"));
  r.mesh = text(at(json, "mesh"));
  return r;
}

ConsistencyRecord consistency_record(const Json& json) {
  ConsistencyRecord r;
  r.coarse = static_cast<int>(figure(at(json, "coarse")).value_or(-1));
  r.fine = static_cast<int>(figure(at(json, "fine")).value_or(-1));
  r.d_H_fit = figure(at(json, "d_H_fit"));
  r.d_H_ddg = figure(at(json, "d_H_ddg"));
  r.d_K_fit = figure(at(json, "d_K_fit"));
  r.d_K_ddg = figure(at(json, "d_K_ddg"));
  r.distance_rms = figure(at(json, "distance_rms"));
  r.fields = text(at(json, "fields"));
  return r;
}

MethodRecord method_record(const std::string& name, const Json& json) {
  MethodRecord method;
  method.name = name;
  method.status = text(at(json, "status"));
  method.seconds = figure(at(json, "seconds"));
  method.peak_memory_bytes = figure(at(json, "peak_memory_bytes"));
  const Json& levels = at(json, "levels");
  const Json& pairs = at(json, "consistency");
  if (levels.is_array()) {
    for (const Json& level : levels) {
      if (level.is_object()) method.levels.push_back(level_record(level, int(method.levels.size())));
    }
  }
  if (pairs.is_array()) {
    for (const Json& pair : pairs) {
      const ConsistencyRecord record = consistency_record(pair);
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

Figure figure_of(const std::string& cell) {
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (end == cell.c_str() || !std::isfinite(value)) return {};
  return value;
}

/// Columns are found by the header's names; a last line cut short by a killed run is left out.
std::vector<IterationSeries> read_steps(const std::filesystem::path& path) {
  std::vector<IterationSeries> all;
  std::istringstream lines(file_if_there(path));
  std::map<std::string, std::size_t> column;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream rest(line + ",");
    for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(cell);
    if (!cells.empty() && !cells.back().empty() && cells.back().back() == '\r') cells.back().pop_back();
    if (column.empty()) {
      for (std::size_t k = 0; k < cells.size(); ++k) column[cells[k]] = k;
      continue;
    }
    if (cells.size() < column.size() || !column.count("method") || !column.count("level")) continue;
    const auto cell = [&](const char* name) {
      return column.count(name) ? figure_of(cells[column.at(name)]) : Figure();
    };
    const std::string& method = cells[column.at("method")];
    const int level = static_cast<int>(cell("level").value_or(0));
    auto series = std::find_if(all.begin(), all.end(), [&](const IterationSeries& s) {
      return s.method == method && s.level == level;
    });
    if (series == all.end()) series = all.insert(all.end(), {method, level, {}});
    series->rows.push_back({cell("seconds"), cell("energy"), cell("decrement"), cell("force_residual"),
                            cell("step_length"), cell("proxy_energy"), cell("step_size"), cell("contacts"),
                            cell("smallest_gap"), cell("intersections")});
  }
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
    if (node) method.step_size = figure_of(node->scalar);
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

  RunData run;
  run.folder = folder;
  run.experiment = text(at(json, "experiment"));
  run.description = text(at(json, "description"));
  run.version = text(at(json, "version"));
  run.table1_scene = text(at(json, "table1_scene"));
  if (const Json& obstacles = at(json, "obstacles"); obstacles.is_array())
    for (const Json& name : obstacles) run.obstacles.push_back(text(name));
  run.complete = at(json, "complete").is_boolean() && at(json, "complete").get<bool>();
  const Json& machine = at(json, "machine");
  run.cpu = text(at(machine, "cpu"));
  run.cores = figure(at(machine, "cores"));
  run.threads = figure(at(machine, "threads"));
  run.force_tolerance = figure(at(at(json, "tolerance"), "force_residual"));
  const Json& methods = at(json, "methods");
  if (methods.is_object()) {
    for (const auto& [name, value] : methods.items()) run.methods.push_back(method_record(name, value));
  }
  // The progressive method leads, whatever the order in the file; the others keep theirs.
  std::stable_partition(run.methods.begin(), run.methods.end(),
                        [](const MethodRecord& m) { return m.name == "pcs"; });
  run.iterations = read_steps(folder / "steps.csv");
  const auto place = [&run](const IterationSeries& s) {
    const auto method = std::find_if(run.methods.begin(), run.methods.end(),
                                     [&s](const MethodRecord& m) { return m.name == s.method; });
    return std::pair(method - run.methods.begin(), s.level);
  };
  std::stable_sort(run.iterations.begin(), run.iterations.end(),
                   [&](const IterationSeries& a, const IterationSeries& b) { return place(a) < place(b); });
  run.configuration = file_if_there(folder / "config.yaml");
  add_last_contacts(run);
  add_step_sizes(run);
  return run;
}

}  // namespace drape
