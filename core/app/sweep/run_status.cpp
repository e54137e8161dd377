#include "core/app/sweep/run_status.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iterator>

#include "core/app/experiment/experiment.h"
#include "core/app/files/file_lock.h"
#include "core/app/report/run_data.h"
#include "core/app/run/checkpoint.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/interfaces/solver.h"

namespace drape {

namespace {

constexpr const char* words[] = {"pending", "running", "converged", "not_converged", "failed", "cancelled"};

/// The status of a run that had results, by what is there of them now.
RunStatus with_sound_results(const RunFiles& files, RunStatus status) {
  if (!std::filesystem::exists(files.results())) {
    status.state = RunState::pending;
    return status;
  }
  try {
    if (member_of(read_results(files.folder, "--retry-failed runs it again"), "complete") != true)
      refuse_path(files.results(), "is of a run that is not complete; --retry-failed runs it again");
  } catch (const std::exception& damaged) {
    status.state = RunState::failed;
    status.error = reason_of(damaged);
    status.exit_code = exit_aborted;
  }
  return status;
}

/// How long a start that was killed had gone on when it last saved its state [s].
double seconds_to_checkpoint(const RunFiles& files) {
  std::error_code begun, saved;
  const auto from = std::filesystem::last_write_time(files.status(), begun),
             to = std::filesystem::last_write_time(files.folder / "checkpoint/state.bin", saved);
  return begun || saved ? 0 : std::max(0.0, std::chrono::duration<double>(to - from).count());
}

std::string last_lines(const std::filesystem::path& file, int most) {
  std::string text = text_of_file(file);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::size_t from = text.size();
  for (int line = 0; line < most && from != std::string::npos && from > 0; ++line)
    from = text.rfind('\n', from - 1);
  return from == std::string::npos || from == 0 ? text : text.substr(from + 1);
}

/// Whether an earlier start was cut and left a state to resume from. Its times count only with the same
/// threads.
bool is_resumable(const RunFiles& files, const RunStatus& status, int threads) {
  return status.state == RunState::cancelled && status.threads == threads && has_checkpoint(files.folder);
}

/// Removes the states of an earlier start that is not resumed, unless a process still uses the folder: the
/// run is then refused. The run itself replaces the other files.
void discard_states(const RunFiles& files) {
  const std::filesystem::path states = files.folder / "checkpoint";
  if (!std::filesystem::is_directory(std::filesystem::symlink_status(states))) return;
  FileLock lock(states / "lock");
  if (!lock.acquire(0)) return;
  remove_checkpoints(files.folder);
  std::filesystem::remove(files.results());
}

RunStatus begin(const RunFiles& files, int threads, bool resumes) {
  const RunStatus before = read_status(files);
  RunStatus status{RunState::running, "", 0, resumes ? before.seconds : 0, before.starts + 1, threads};
  // First: cut between the two, a run that is marked as running would resume from what should be gone.
  if (before.starts > 0 && !resumes) discard_states(files);
  write_status(files, status);
  write_file(files.log(), "");
  return status;
}

std::vector<std::string> command(const RunFiles& files, const SweepOptions& options, bool resumes) {
  const std::string folder = std::filesystem::absolute(files.folder);  // may begin with "-"
  const std::string config = std::filesystem::absolute(files.config());
  // The sweep has checked the memory.
  std::vector<std::string> all = {own_program(),
                                  "run",
                                  "--quiet",
                                  "--allow-memory",
                                  "--measure",
                                  "--threads",
                                  std::to_string(options.threads)};
  if (!options.report) all.emplace_back("--no-report");
  if (resumes)
    all.insert(all.end(), {"--resume", folder});
  else  // the config has the chosen methods only
    all.insert(all.end(), {config, "--out", folder, "--overwrite", "--method", all_methods});
  return all;
}

}  // namespace

const char* to_string(RunState state) { return words[int(state)]; }

Json RunStatus::json() const {
  return {{"status", to_string(state)}, {"error", error},   {"exit_code", exit_code},
          {"seconds", seconds},         {"starts", starts}, {"threads", threads}};
}

RunStatus read_status(const RunFiles& files) {
  const std::string text = text_of_file(files.status());
  if (text.empty()) return {};
  const JsonFile file(files.status(), "remove it and the run's folder");
  const Json json = parse_json(text);
  if (!json.is_object()) file.refuse("is not a run's status");
  RunStatus status;
  const auto word = file.at<std::string>(json, "status");
  const auto* found = std::ranges::find(words, word);
  if (found == std::end(words)) file.refuse("no status is called \"" + excerpt(word) + "\"");
  status.state = RunState(found - words);
  status.error = file.at<std::string>(json, "error");
  status.exit_code = file.at<int>(json, "exit_code");
  status.seconds = file.at<double>(json, "seconds");
  status.starts = file.at<int>(json, "starts");
  status.threads = file.at<int>(json, "threads");
  return status;
}

void write_status(const RunFiles& files, const RunStatus& status) {
  make_folder(files.folder.parent_path());
  write_file(files.status(), json_text(status.json(), 1) + "\n");
}

RunStatus resolve_status(const RunFiles& files, RunStatus status) {
  if (status.has_results()) return with_sound_results(files, std::move(status));
  // A refused run has not begun: results in its folder may be of another experiment.
  if (status.state == RunState::pending || status.refused()) return status;
  if (status.state == RunState::running) {
    status.state = RunState::cancelled;
    status.seconds += seconds_to_checkpoint(files);
  }
  const Json results = complete_results(files.folder);
  if (results.is_null()) return status;
  const JsonFile file(files.results(), remedy_of_results);
  status.state = RunState::converged;
  status.error.clear();
  status.seconds = 0;
  for (const auto& [name, method] : results["methods"].items()) {
    if (!has_converged(file.find<std::string>(method, "status").value_or("")))
      status.state = RunState::not_converged;
    status.seconds += file.find<double>(method, "seconds").value_or(0);
  }
  status.exit_code = status.state == RunState::converged ? exit_done : exit_not_converged;
  return status;
}

RunProcess::RunProcess(RunFiles files, const SweepOptions& options, double time_limit)
    : files_(std::move(files)),
      resumes_(is_resumable(files_, read_status(files_), options.threads)),
      status_(begin(files_, options.threads, resumes_)),
      clock_(status_.seconds),
      time_limit_(time_limit),
      process_(command(files_, options, resumes_), files_.log(), files_.log()) {}

bool RunProcess::ended() {
  if (status_.state != RunState::running) return true;
  const std::optional<Exit> exit = process_.poll();
  const double seconds = clock_.seconds();
  if (!exit) {
    if (time_limit_ > 0 && seconds > time_limit_ && !too_slow_) {
      too_slow_ = true;
      process_.signal(SIGKILL);
    }
    return false;
  }
  status_ = resolve_status(files_, status_);
  status_.seconds = seconds;
  // What is resumed had begun: that another process uses it is no fault of its input.
  status_.exit_code = resumes_ && exit->code == exit_bad_input ? exit_aborted : exit->code;
  const int signal = exit->code - exit_by_signal;
  const bool stopped = stopped_ || signal == SIGINT || signal == SIGTERM || signal == SIGHUP;
  if (status_.state == RunState::cancelled && !stopped) {
    status_.state = RunState::failed;
    // A refusal lists every fault, and its sweep may expect any of them.
    const std::string said = last_lines(files_.log(), status_.refused() ? 200 : 5);
    if (too_slow_) {
      status_.exit_code = exit_too_slow;
      status_.error = "exceeded the sweep's time_limit";
    } else if (exit->signal)
      status_.error =
          "ended by signal " + std::to_string(exit->signal) + " (" + strsignal(exit->signal) + ")";
    else if (said.empty())
      status_.error = "ended with exit code " + std::to_string(exit->code);
    status_.error += (status_.error.empty() || said.empty() ? "" : "\n") + said;
  }
  write_status(files_, status_);
  return true;
}

}  // namespace drape
