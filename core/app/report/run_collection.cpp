#include "core/app/report/run_collection.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment_path.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

bool is_run_or_sweep(const fs::path& folder) {
  return is_sweep(folder) || fs::is_regular_file(folder / "results.json");
}

/// Reads a sweep's run. One whose files are damaged has failed: the others are still read.
void read_data(RunRecord& run, RunCollection& collection) {
  try {
    run.data = read_run(run.folder);
  } catch (const std::exception& damaged) {
    run.status = "failed";
    run.exit_code = exit_aborted;
    run.error = reason_of(damaged);
    collection.complete = false;
  }
}

/// Adds the runs of a sweep, whose name is returned.
std::string read_sweep(const fs::path& folder, RunCollection& collection) {
  const fs::path path = folder / "sweep.json";
  const Json json = parse_json(read_file(path));
  if (!json.is_object() || !json.contains("runs") || !json["runs"].is_array())
    refuse_path(path, "not a sweep's list of runs; is it cut short?");
  const JsonFile file(path, "run the sweep again, which writes it");
  collection.complete = collection.complete && member_of(json, "complete") == true;
  std::string name = text_member(json, "sweep");
  collection.description += text_member(json, "description");
  for (const Json& entry : json["runs"]) {
    if (!entry.is_object()) continue;
    RunRecord& run = collection.runs.emplace_back();
    run.sweep = name;
    run.name = run.variation = text_member(entry, "name");
    run.status = text_member(entry, "status");
    run.settings = member_of(entry, "settings");
    run.error = text_member(entry, "error");
    run.exit_code = file.find<int>(entry, "exit_code").value_or(0);
    if (const Json& expect = member_of(entry, "expect"); expect.is_object()) {
      run.expected = text_member(expect, "status");
      run.expected_message = text_member(expect, "message");
    }
    run.folder = file.place(entry, "folder");
    run.seed = number_member(entry, "seed");
    // Running and failed runs may have written files; only complete ones have results.
    const bool has_results = run.status == "converged" || run.status == "not_converged";
    if (has_results && fs::is_regular_file(run.folder / "results.json")) read_data(run, collection);
  }
  return name;
}

/// The configuration without its seed, which is returned in `seed`.
std::string config_but_seed(const RunData& run, OptionalNumber& seed) {
  ConfigNode config = run.config;
  if (const ConfigNode* node = value_at(config, "start.seed"); node && node->is_number()) seed = node->number;
  for (auto& [key, value] : config.entries)
    if (key == "start") value.remove("seed");
  return config.entries.empty() ? run.folder.string() : to_yaml(config);
}

void read_single_runs(const std::vector<fs::path>& folders, RunCollection& collection) {
  std::map<std::string, std::map<std::string, std::string>> folder_of;  // by experiment and configuration
  std::vector<std::string> configs;
  const std::size_t first = collection.runs.size();
  for (const fs::path& folder : folders) {
    RunRecord& run = collection.runs.emplace_back();
    run.folder = folder;
    run.data = read_run(folder);
    configs.push_back(config_but_seed(*run.data, run.seed));
    folder_of[run.data->experiment].try_emplace(configs.back(), folder.string());
    run.status = run.data->converged() ? "converged" : "not_converged";
    collection.complete = collection.complete && run.data->complete;
  }
  for (std::size_t k = 0; k < folders.size(); ++k) {
    RunRecord& run = collection.runs[first + k];
    const auto& variations = folder_of[run.data->experiment];
    run.name = run.variation = variations.size() == 1 ? run.data->experiment : variations.at(configs[k]);
  }
}

/// The folder itself, or the runs and sweeps that are folders in it, in the order of their names.
std::vector<fs::path> runs_at(const fs::path& folder) {
  if (is_run_or_sweep(folder)) return {folder};
  std::vector<fs::path> found;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(folder, unreadable))
    if (is_run_or_sweep(entry.path())) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  if (found.empty()) require_run_or_sweep(folder);
  return found;
}

}  // namespace

std::vector<DeclaredMetric> RunCollection::metrics() const {
  std::vector<DeclaredMetric> all;
  for (const RunRecord& run : runs)
    if (run.data) merge(all, run.data->metrics);
  return all;
}

bool is_sweep(const fs::path& folder) { return fs::is_regular_file(folder / "sweep.json"); }

void require_run_or_sweep(const fs::path& folder) {
  if (is_run_or_sweep(folder)) return;
  throw std::runtime_error(folder.string() +
                           ": neither results.json nor sweep.json here; give the folder of a run or a sweep");
}

RunCollection read_runs(const std::vector<fs::path>& given) {
  RunCollection collection;
  std::vector<fs::path> folders;
  for (const fs::path& folder : given)
    for (fs::path& each : runs_at(folder)) folders.push_back(std::move(each));
  std::vector<fs::path> single, sweep_of_run;
  std::vector<std::string> names;  // of the sweeps, else of the experiments
  for (const fs::path& folder : folders) {
    if (is_sweep(folder)) {
      names.push_back(read_sweep(folder, collection));
      sweep_of_run.resize(collection.runs.size(), folder);
    } else {
      single.push_back(folder);
    }
  }
  // Runs of two sweeps are not repeats of each other, even if their variations have one name.
  const bool several = !names.empty() && folders.size() > 1;
  for (std::size_t k = 0; several && k < collection.runs.size(); ++k) {
    RunRecord& run = collection.runs[k];
    const bool named = !run.sweep.empty() && std::ranges::count(names, run.sweep) == 1;
    run.variation = (named ? run.sweep : sweep_of_run[k].string()) + ": " + run.name;
  }
  read_single_runs(single, collection);
  std::erase(names, "");
  const bool unnamed = names.empty();
  for (const RunRecord& run : collection.runs)
    if (unnamed && run.data) add_new(names, run.data->experiment);
  collection.name = joined(names);
  return collection;
}

}  // namespace drape
