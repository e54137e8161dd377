#include "core/app/sweep/sweep_folder.h"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <set>

#include "core/app/experiment/cloth.h"
#include "core/app/files/json_file.h"
#include "core/app/report/run_data.h"
#include "core/app/run/run_folder.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace fs = std::filesystem;

namespace {

std::string title(const std::string& name, int seed) {
  return "run \"" + name + "\", seed " + std::to_string(seed);
}

/// What an entry of sweep.json's runs expects of its run.
Expectation expectation_of(const Json& run) { return {run["expect"]["status"], run["expect"]["message"]}; }

}  // namespace

Json SweepFolder::find() const {
  const fs::path file = path_ / "sweep.json";
  const std::string text = text_of_file(file);
  if (text.empty()) return nullptr;
  Json json = parse_json(text);
  const JsonFile sweep(file, "name another folder with --out");
  if (!json.is_object() || !json.contains("sweep") || !json.contains("runs"))
    sweep.refuse("is not a sweep's");
  sweep.at<std::string>(json, "sweep");
  sweep.at<double>(json, "time_limit");
  if (!json["runs"].is_array()) sweep.refuse("\"runs\" must be a list");
  for (const Json& run : json["runs"]) {
    sweep.at<std::string>(run, "name");
    sweep.place(run, "folder");
    sweep.at<int>(run, "seed");
    const Json& expect = member_of(run, "expect");
    for (const std::string key : {"status", "message"})
      if (!sweep.find<std::string>(expect, key)) sweep.refuse("\"runs[].expect." + key + "\" is missing");
  }
  return json;
}

Json SweepFolder::read() const {
  Json json = find();
  if (json.is_null()) refuse_path(path_, "has no sweep.json; is it a sweep's folder?");
  return json;
}

std::vector<RunStatus> SweepFolder::checked_statuses(const Sweep& sweep, int threads) const {
  const auto refuse_results = [&](const std::string& fault, const RunFiles& files) {
    refuse_path(path_, fault +
                           "; give the new sweep another folder with --out, or undo the change, or delete "
                           "that run's files to run it again: " +
                           files.folder.string() + "*");
  };
  Json before = find();
  // Without it the runs' own files tell what there is.
  if (before.is_null()) before = {{"sweep", sweep.parameters.name}, {"runs", Json::array()}};
  if (const std::string other = before["sweep"]; other != sweep.parameters.name)
    refuse_path(path_, "holds the sweep \"" + other + "\"; name another folder with --out");
  std::set<std::string> folders;
  for (const SweepRun& run : sweep.runs) folders.insert(run.folder);
  for (const Json& run : before["runs"]) {
    const RunFiles files = this->files(run["folder"]);
    if (!folders.count(run["folder"]) && read_status(files).has_results())
      refuse_results("has results of " + title(run["name"], run["seed"]) + ", which the sweep no longer has",
                     files);
  }
  std::vector<RunStatus> statuses;
  for (const SweepRun& run : sweep.runs) {
    const RunFiles files = this->files(run.folder);
    refuse_links(path_, run.folder);
    const RunStatus& status = statuses.emplace_back(resolve_status(files, read_status(files)));
    // A status is written before the config, and the log when the run begins. A link is replaced, not
    // followed.
    const auto is_foreign = [&](const fs::path& file) {
      const bool has_begun = status.starts > 0, is_planned = has_begun || fs::exists(files.status());
      return fs::exists(fs::symlink_status(file)) && !fs::is_symlink(file) &&
             !(file == files.config() ? is_planned || text_of_file(file) == run.config : has_begun);
    };
    for (const fs::path& file : {files.folder, files.config(), files.log()})
      if (is_foreign(file))
        refuse_path(
            file,
            "is there already, and not from this sweep; move it away, or name another folder with --out");
    if (!status.has_results()) {
      if (!complete_results(files.folder).is_null())
        refuse_path(
            files.folder,
            "has complete results, but not from this sweep; move it away, or name another folder with --out");
      continue;
    }
    if (text_of_file(files.config()) != run.config)
      refuse_results("the results of " + title(run.name, run.seed) +
                         " are of another experiment than the sweep now says",
                     files);
    if (status.threads != threads)
      refuse_results(title(run.name, run.seed) + " was made with " + std::to_string(status.threads) +
                         (status.threads == 1 ? " thread" : " threads") + " per run, not " +
                         std::to_string(threads) + ", so times would not compare",
                     files);
  }
  return statuses;
}

std::vector<std::size_t> SweepFolder::prepare(const Sweep& sweep, int threads, bool retry_failed) const {
  std::vector<RunStatus> statuses = checked_statuses(sweep, threads);
  std::vector<std::size_t> missing;
  Json json = {{"sweep", sweep.parameters.name},
               {"description", sweep.parameters.description},
               {"config", sweep.file.string()},
               {"complete", false},
               {"threads", threads},
               {"time_limit", sweep.parameters.time_limit.value_or(0)},
               {"runs", Json::array()}};
  for (const SweepRun& run : sweep.runs)
    json["runs"].push_back({{"name", run.name},
                            {"settings", run.settings},
                            {"seed", run.seed},
                            {"folder", run.folder},
                            {"expect", {{"status", run.expect.status}, {"message", run.expect.message}}}});
  write(json);  // first: without it what follows would be a folder of runs and no sweep
  for (std::size_t k = 0; k < sweep.runs.size(); ++k) {
    const SweepRun& run = sweep.runs[k];
    const RunFiles files = this->files(run.folder);
    make_folder(files.folder.parent_path());
    RunStatus& status = statuses[k];
    const bool is_other = text_of_file(files.config()) != run.config;
    if (is_other && (status.state == RunState::failed || status.state == RunState::cancelled))
      status.state = RunState::pending;
    if (!fs::exists(files.status()) || status.state != read_status(files).state) write_status(files, status);
    if (is_other) write_file(files.config(), run.config);
    const bool stays = status.has_results() || refused_as_expected(run.expect, status) ||
                       (status.state == RunState::failed && !retry_failed);
    if (!stays) missing.push_back(k);
  }
  write(std::move(json));
  return missing;
}

void SweepFolder::refresh() const { write(read()); }

void SweepFolder::write(Json json) const {
  bool complete = true;
  for (Json& run : json["runs"]) {
    const RunStatus status = read_status(files(run["folder"]));
    run.update(status.json());
    complete = complete && (status.has_results() || refused_as_expected(expectation_of(run), status));
  }
  json["complete"] = complete;
  write_file(path_ / "sweep.json", json_text(json, 1) + "\n");
}

void SweepFolder::finalize() const {
  const Json json = read();
  for (const Json& run : json["runs"]) {
    const RunFiles files = this->files(run["folder"]);
    const RunStatus before = read_status(files), status = resolve_status(files, before);
    if (status.state != before.state) write_status(files, status);
  }
  refresh();
}

void SweepFolder::refuse_foreign() const {
  std::error_code none;
  if (fs::exists(path_ / "sweep.lock") || fs::exists(path_ / "sweep.json")) return;
  for (const auto& entry : fs::directory_iterator(path_, none))
    if (const std::string name = entry.path().filename(); name != "sweep.lock")
      refuse_path(path_, "holds " + name + ", and no sweep; name another folder with --out");
}

std::unique_ptr<FileLock> SweepFolder::lock() const {
  make_results_folder(path_);
  refuse_foreign();
  auto lock = std::make_unique<FileLock>(path_ / "sweep.lock");
  // Wait a moment for the runs of a sweep that has just been killed.
  if (!lock->acquire(1))
    refuse_path(path_, "another `drape sweep` uses this folder (" + lock->holder() +
                           "); wait for it, or name another folder with --out");
  return lock;
}

MemoryEstimate::MemoryEstimate(const Sweep& sweep, const SweepFolder& folder) {
  for (const SweepRun& run : sweep.runs)
    if (const RunFiles files = folder.files(run.folder); read_status(files).has_results()) learn(run, files);
}

void MemoryEstimate::learn(const SweepRun& run, const RunFiles& files) {
  const JsonFile file(files.results(), remedy_of_results);
  const Json results = complete_results(files.folder);
  double& peak = peaks_[{run.vertices, run.levels}];
  for (const auto& [name, method] : member_of(results, "methods").items())
    peak = std::max(peak, file.find<double>(method, "peak_memory_bytes").value_or(0));
}

double MemoryEstimate::bytes(const SweepRun& run) const {
  const auto known = peaks_.find({run.vertices, run.levels});
  if (known != peaks_.end() && known->second > 0) return known->second;
  return estimated_memory(run.vertices);
}

void MemoryEstimate::require(const Sweep& sweep, const SweepFolder& folder, double machine) const {
  for (const SweepRun& run : sweep.runs)
    if (bytes(run) > machine && !read_status(folder.files(run.folder)).has_results())
      throw std::runtime_error(run.name + ", seed " + std::to_string(run.seed) + ", may need " +
                               memory_text(bytes(run)) + " of memory, where this machine has " +
                               memory_text(machine) +
                               "; take fewer levels or vertices, or allow it with --allow-memory");
}

std::string duration_text(double seconds) {
  if (seconds < 90) return fixed_text(seconds, 1) + " s";
  return seconds < 5400 ? fixed_text(seconds / 60, 0) + " min" : fixed_text(seconds / 3600, 1) + " h";
}

std::string list_of_runs(const SweepFolder& folder) {
  std::vector<std::vector<std::string>> rows = {{"variation", "seed", "status", "time"}};
  const Json sweep = folder.read();
  for (const Json& run : sweep["runs"]) {
    const RunStatus status = read_status(folder.files(run["folder"]));
    const bool expected = refused_as_expected(expectation_of(run), status);
    std::string end = status.seconds > 0 ? duration_text(status.seconds) : "";
    if (status.state == RunState::failed && !expected)
      end += "\n    " + boost::replace_all_copy(status.error, "\n", "\n    ");
    rows.push_back({printable(run["name"].get<std::string>()), json_text(run["seed"]),
                    expected ? "refused, as expected" : to_string(status.state), end});
  }
  return text_table(rows);
}

}  // namespace drape
