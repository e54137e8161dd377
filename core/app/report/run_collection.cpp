#include "core/app/report/run_collection.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "core/app/experiment/exit_codes.h"
#include "core/app/files/csv.h"
#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/file.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

void read_sweep(const fs::path& folder, RunCollection& collection) {
  const fs::path path = folder / "sweep.json";
  const Json json = parse_json(read_file(path));
  if (!json.is_object() || !json.contains("runs") || !json["runs"].is_array())
    throw std::runtime_error(path.string() + ": not a sweep's list of runs; is it cut short?");
  const JsonFile file(path, "run the sweep again, which writes it");
  const auto complete = json.find("complete");
  collection.complete =
      collection.complete && complete != json.end() && complete->is_boolean() && complete->get<bool>();
  collection.name += (collection.name.empty() ? "" : ", ") + text_member(json, "sweep");
  for (const Json& entry : json["runs"]) {
    if (!entry.is_object()) continue;
    RunRecord run;
    run.sweep = text_member(json, "sweep");
    run.name = run.variation = text_member(entry, "name");
    run.status = text_member(entry, "status");
    run.settings = member_of(entry, "settings");
    run.error = text_member(entry, "error");
    run.exit_code = file.find<int>(entry, "exit_code").value_or(0);
    if (const auto expect = entry.find("expect"); expect != entry.end() && expect->is_object()) {
      run.expected = text_member(*expect, "status");
      run.expected_message = text_member(*expect, "message");
    }
    run.folder = folder / text_member(entry, "folder");
    if (const auto seed = entry.find("seed"); seed != entry.end() && seed->is_number())
      run.seed = seed->get<double>();
    // Running and failed runs may have written files; only complete ones have results.
    const bool has_results = run.status == "converged" || run.status == "not_converged";
    if (has_results && fs::is_regular_file(run.folder / "results.json")) run.data = read_run(run.folder);
    collection.runs.push_back(std::move(run));
  }
}

/// The configuration without its seed, which is returned in `seed`.
std::string config_but_seed(const RunData& run, OptionalNumber& seed) {
  ConfigErrors errors;
  ConfigNode config = parse_yaml(run.configuration, "config.yaml", errors);
  for (auto& [key, value] : config.entries) {
    if (key != "start") continue;
    for (auto& [own, node] : value.entries)
      if (own == "seed") {
        seed = number_of(node.scalar);
        node.scalar.clear();
      }
  }
  return errors.empty() ? to_yaml(config) : run.folder.string();
}

std::string folder_name(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

void read_single_runs(const std::vector<fs::path>& folders, RunCollection& collection) {
  std::map<std::string, std::set<std::string>> configs_of;  // by the experiment's name
  std::map<std::string, int> folders_of;                    // by the folder's
  std::vector<std::string> configs;
  const std::size_t first = collection.runs.size();
  for (const fs::path& folder : folders) {
    RunRecord run;
    run.folder = folder;
    run.data = read_run(folder);
    configs.push_back(config_but_seed(*run.data, run.seed));
    configs_of[run.data->experiment].insert(configs.back());
    ++folders_of[folder_name(folder)];
    bool converged = run.data->complete;
    for (const MethodRecord& m : run.data->methods) converged = converged && has_converged(m.status);
    run.status = converged ? "converged" : "not_converged";
    collection.runs.push_back(std::move(run));
  }
  std::map<std::string, std::string> name_of;  // a configuration's
  std::set<std::string> names;                 // those that are taken
  for (std::size_t k = 0; k < folders.size(); ++k) {
    RunRecord& run = collection.runs[first + k];
    const std::string& experiment = run.data->experiment;
    const std::string folder = folder_name(folders[k]);
    const std::string own = configs_of[experiment].size() == 1 ? experiment
                            : folders_of[folder] > 1           ? folders[k].string()
                                                               : folder;
    const auto [found, added] = name_of.emplace(configs[k], own);
    if (added && !names.insert(own).second) found->second = folders[k].string();
    run.name = run.variation = found->second;
  }
}

/// The runs that were read from one sweep's folder, or last those that are by themselves.
struct Source {
  fs::path folder;  ///< empty for runs by themselves
  std::size_t begin, end;
};

/// Runs of two sweeps are no repeats of each other, even if their variations have one name.
void keep_apart(const std::vector<Source>& sources, std::vector<RunRecord>& runs) {
  std::map<std::string, std::set<std::size_t>> sources_of;  // by the name of a variation
  std::map<std::string, int> sweeps_of;                     // by their name
  for (std::size_t s = 0; s < sources.size(); ++s) {
    for (std::size_t k = sources[s].begin; k < sources[s].end; ++k) sources_of[runs[k].name].insert(s);
    if (sources[s].begin < sources[s].end) ++sweeps_of[runs[sources[s].begin].sweep];
  }
  for (const Source& source : sources)
    for (std::size_t k = source.begin; k < source.end; ++k) {
      RunRecord& run = runs[k];
      if (sources_of[run.name].size() < 2 || source.folder.empty()) continue;
      const bool named = !run.sweep.empty() && sweeps_of[run.sweep] == 1;
      run.variation = (named ? run.sweep : source.folder.string()) + ": " + run.name;
    }
}

}  // namespace

std::vector<std::string> RunCollection::variations() const {
  std::vector<std::string> names;
  for (const RunRecord& run : runs)
    if (std::find(names.begin(), names.end(), run.variation) == names.end()) names.push_back(run.variation);
  return names;
}

std::vector<std::string> RunCollection::methods() const {
  std::vector<std::string> names;
  for (const RunRecord& run : runs)
    if (run.data)
      for (const MethodRecord& m : run.data->methods)
        if (std::find(names.begin(), names.end(), m.name) == names.end()) names.push_back(m.name);
  return names;
}

std::vector<const RunRecord*> RunCollection::of(const std::string& variation) const {
  std::vector<const RunRecord*> found;
  for (const RunRecord& run : runs)
    if (run.variation == variation) found.push_back(&run);
  return found;
}

std::vector<DeclaredMetric> RunCollection::metrics() const {
  std::vector<DeclaredMetric> all;
  for (const RunRecord& run : runs)
    if (run.data) merge(all, run.data->metrics);
  return all;
}

std::vector<ErrorMeasure> RunCollection::error_measures() const {
  std::vector<ErrorMeasure> all;
  for (const RunRecord& run : runs) {
    if (!run.data) continue;
    for (const ErrorMeasure& m : run.data->error_measures)
      if (std::none_of(all.begin(), all.end(), [&](const ErrorMeasure& own) { return own.name == m.name; }))
        all.push_back(m);
  }
  return all.empty() ? drape::error_measures({}) : all;
}

bool RunRecord::refused() const {
  return status == "failed" && exit_code == exit_bad_input && !fs::exists(folder / "results.json");
}

bool is_sweep(const fs::path& folder) { return fs::is_regular_file(folder / "sweep.json"); }

void require_run_or_sweep(const fs::path& folder) {
  if (is_sweep(folder) || fs::is_regular_file(folder / "results.json")) return;
  throw std::runtime_error(folder.string() +
                           ": neither results.json nor sweep.json here; give the folder of a run or a sweep");
}

RunCollection read_runs(const std::vector<fs::path>& folders) {
  RunCollection collection;
  std::vector<fs::path> single;
  std::vector<Source> sources;
  for (const fs::path& folder : folders) {
    if (is_sweep(folder)) {
      const std::size_t begin = collection.runs.size();
      read_sweep(folder, collection);
      sources.push_back({folder, begin, collection.runs.size()});
    } else {
      require_run_or_sweep(folder);
      single.push_back(folder);
    }
  }
  const std::size_t begin = collection.runs.size();
  read_single_runs(single, collection);
  sources.push_back({{}, begin, collection.runs.size()});
  keep_apart(sources, collection.runs);
  if (collection.name.empty()) {
    std::vector<std::string> names;
    for (const RunRecord& run : collection.runs)
      if (run.data && std::find(names.begin(), names.end(), run.data->experiment) == names.end())
        names.push_back(run.data->experiment);
    for (const std::string& name : names) collection.name += (collection.name.empty() ? "" : ", ") + name;
  }
  return collection;
}

}  // namespace drape
