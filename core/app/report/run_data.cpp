#include "core/app/report/run_data.h"

#include <algorithm>
#include <regex>
#include <stdexcept>

#include "core/app/experiment/exit_codes.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/file.h"
#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

namespace {

/// The members of a list; none where it has something else.
const Json& list(const Json& json) {
  static const Json none = Json::array();
  return json.is_array() ? json : none;
}

LevelRecord level_of(const Json& json, std::size_t position, const JsonFile& file) {
  return {.level = file.find<int>(json, "level").value_or(static_cast<int>(position)),
          .status = text_member(json, "status"),
          .message = text_member(json, "message"),
          .mesh = level_mesh(file, json),
          .from_initial_state = member_of(json, "from_initial_state") == true,
          .values = json};
}

MethodRecord method_of(const std::string& name, const Json& json, const JsonFile& file) {
  MethodRecord method;
  method.name = name;
  method.status = text_member(json, "status");
  method.solver = text_member(json, "solver");
  for (const Json& entry : list(member_of(json, "levels")))
    if (entry.is_object()) method.levels.push_back(level_of(entry, method.levels.size(), file));
  for (const Json& pair : list(member_of(json, "consistency"))) {
    const int coarse = file.find<int>(pair, "coarse").value_or(-1),
              fine = file.find<int>(pair, "fine").value_or(-1);
    if (coarse >= 0 && fine > coarse)
      method.consistency.push_back(
          {coarse, fine, pair, RunFile::of(file, pair, "fields", "fields_checksum")});
  }
  std::ranges::stable_sort(method.levels, {}, &LevelRecord::level);
  return method;
}

}  // namespace

const Json& LevelRecord::snapshots() const { return member_of(values, "snapshots"); }

int MethodRecord::first_level() const {
  int first = levels.empty() ? 0 : levels.front().level;
  for (const LevelRecord& level : levels)
    if (level.from_initial_state) first = level.level;
  return first;
}

std::vector<const LevelRecord*> MethodRecord::recorded_levels() const {
  std::vector<const LevelRecord*> recorded;
  for (const LevelRecord& level : levels)
    if (level.mesh.is_named()) recorded.push_back(&level);
  return recorded;
}

OptionalNumber MethodRecord::cost(const std::string& value) const {
  OptionalNumber sum;
  for (const LevelRecord& level : levels) {
    if (level.from_initial_state) sum.reset();
    if (const OptionalNumber known = number_member(level.values, value)) sum = sum.value_or(0) + *known;
  }
  return sum;
}

bool RunData::converged() const {
  return complete &&
         std::ranges::all_of(methods, [](const MethodRecord& m) { return has_converged(m.status); });
}

bool RunData::has_contact() const {
  for (const MethodRecord& m : methods)
    for (const LevelRecord& r : m.levels)
      if (number_member(r.values, "intersections") || number_member(r.values, "smallest_gap")) return true;
  return false;
}

int RunData::finest_level() const {
  int finest = -1;
  for (const MethodRecord& m : methods)
    for (const LevelRecord& r : m.levels) finest = std::max(finest, r.level);
  return finest;
}

RunFile RunData::rest(int level) const { return {folder / rest_file(level), {}}; }

SnapshotFile RunData::snapshots(const LevelRecord& level, Eigen::Index n) const {
  const RunFile file = RunFile::of(results_file(folder), level.snapshots(), "file", "checksum");
  if (!file.is_named()) return {};
  const Json &iterations = list(member_of(level.snapshots(), "iterations")),
             &seconds = list(member_of(level.snapshots(), "seconds"));
  if (iterations.size() != seconds.size())
    refuse_path(file.path, "results.json has other numbers of iterations and seconds");
  return {file.path, iterations.size(), n, file.checksum};
}

bool is_file_of_run(const std::string& folder, const std::string& name) {
  if (folder.empty()) return std::ranges::count(own_files, name) > 0;
  return std::ranges::any_of(own_folders, [&](const auto& own) {
    return folder == own.first && std::regex_match(name, std::regex(own.second));
  });
}

JsonFile results_file(const std::filesystem::path& folder) {
  return {folder / "results.json", "run the experiment again"};
}

RunFile level_mesh(const JsonFile& results, const Json& level) {
  return RunFile::of(results, level, "mesh", "mesh_checksum");
}

std::string rest_file(int level) { return "rest/l" + std::to_string(level) + ".ply"; }

Json read_results(const std::filesystem::path& folder, const std::string& remedy) {
  const std::filesystem::path path = folder / "results.json";
  if (!std::filesystem::is_regular_file(path))
    refuse_path(folder, "no results.json here; give the folder of a run");
  Json json = parse_json(read_file(path));
  const JsonFile file(path, remedy);
  if (!json.is_object()) file.refuse("is damaged or cut short: it is not a JSON object");
  if (!member_of(json, "methods").is_object()) file.refuse("is damaged: \"methods\" is not a map");
  file.find<bool>(json, "complete");  // refuses what is not a boolean
  return json;
}

Json complete_results(const std::filesystem::path& folder) {
  try {
    Json results = read_results(folder);
    if (member_of(results, "complete") == true) return results;
  } catch (const std::runtime_error&) {
    // Missing, or damaged as by a power cut.
  }
  return nullptr;
}

RunData read_run(const std::filesystem::path& folder) {
  RunData run;
  run.folder = folder;
  run.results = read_results(folder);
  const Json& json = run.results;
  const JsonFile file = results_file(folder);

  run.experiment = text_member(json, "experiment");
  run.complete = member_of(json, "complete") == true;
  for (const Json& obstacle : list(member_of(json, "obstacles")))
    run.obstacles.push_back({RunFile::of(file, obstacle, "mesh"), text_member(obstacle, "name")});
  run.reference = text_member(member_of(json, "reference"), "method");
  run.metrics = declared_metrics(member_of(json, "metrics"));
  if (const std::filesystem::path config = folder / "config.yaml"; std::filesystem::is_regular_file(config)) {
    run.configuration = read_file(config);
    ConfigErrors unread;
    run.config = parse_yaml(run.configuration, "config.yaml", unread);
  }
  for (const auto& [name, value] : member_of(json, "methods").items())
    run.methods.push_back(method_of(name, value, file));
  // The progressive method comes first; the others stay in file order.
  std::ranges::stable_partition(run.methods, [](const MethodRecord& m) { return m.name == "pcs"; });
  run.iterations = Csv(folder / "iterations.csv");
  run.errors = Csv(folder / "errors.csv");
  return run;
}

}  // namespace drape
