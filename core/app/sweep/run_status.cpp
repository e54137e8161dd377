#include "core/app/sweep/run_status.h"

#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/app/experiment/method_choice.h"
#include "core/app/files/json_file.h"
#include "core/kernel/mesh/file.h"
#include "core/kernel/mesh/message_text.h"
#include "core/kernel/model/solver.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* words[] = {"pending", "running", "converged", "not_converged", "failed", "cancelled"};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The last few lines of a run's output.
std::string last_lines(const std::filesystem::path& file) {
  std::string text = text_of_file(file);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::size_t from = text.size();
  for (int line = 0; line < 5 && from != std::string::npos && from > 0; ++line)
    from = text.rfind('\n', from - 1);
  return from == std::string::npos || from == 0 ? text : text.substr(from + 1);
}

/// Marks the run as running and removes the files of an earlier start.
RunStatus begin(const RunFiles& files, int threads) {
  const int starts = read_status(files).starts;
  RunStatus status{RunState::running, "", 0, 0, starts + 1, threads};
  write_status(files, status);
  if (starts > 0) std::filesystem::remove_all(files.folder);
  std::filesystem::remove(files.log());
  return status;
}

std::vector<std::string> command(const RunFiles& files, int threads, bool report) {
  std::vector<std::string> all = {own_program(),   "run",       files.config(), "--out",
                                  files.folder,    "--quiet",   "--threads",    std::to_string(threads),
                                  "--method",      all_methods,  // the config has the chosen ones only
                                  "--allow-memory"};             // the sweep has checked it
  if (!report) all.emplace_back("--no-report");
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
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) file.refuse("is not a run's status");
  RunStatus status;
  const auto word = file.at<std::string>(json, "status");
  if (word == "ended") file.refuse("status \"ended\" is now called \"not_converged\"");
  if (word == "waiting") file.refuse("status \"waiting\" is now called \"pending\"");
  const auto* found = std::find(std::begin(words), std::end(words), word);
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
  write_file(files.status(), status.json().dump(1) + "\n");
}

RunStatus resolve_interrupted(const RunFiles& files, RunStatus status) {
  if (status.state != RunState::running) return status;
  status.state = RunState::cancelled;
  const std::filesystem::path path = files.folder / "results.json";
  const JsonFile file(path, "remove the run's folder, and the sweep runs it again");
  const Json results = Json::parse(text_of_file(path), nullptr, false);
  if (!file.find<bool>(results, "complete").value_or(false)) return status;
  if (!results.contains("methods")) file.refuse("\"methods\" is missing");
  status.state = RunState::converged;
  status.seconds = 0;
  for (const auto& [name, method] : results["methods"].items()) {
    if (!has_converged(file.find<std::string>(method, "status").value_or("")))
      status.state = RunState::not_converged;
    status.seconds += file.find<double>(method, "seconds").value_or(0);
  }
  status.exit_code = status.state == RunState::converged ? exit_done : exit_not_converged;
  return status;
}

RunProcess::RunProcess(RunFiles files, const RunProcessOptions& options)
    : files_(std::move(files)),
      status_(begin(files_, options.threads)),
      began_(now()),
      time_limit_(options.time_limit),
      process_(command(files_, options.threads, options.report), files_.log(), files_.log()) {}

bool RunProcess::ended() {
  if (status_.state != RunState::running) return true;
  const std::optional<Exit> exit = process_.poll();
  const double seconds = now() - began_;
  if (!exit) {
    if (time_limit_ > 0 && seconds > time_limit_ && !too_slow_) {
      too_slow_ = true;
      process_.signal(SIGKILL);
    }
    return false;
  }
  status_ = resolve_interrupted(files_, status_);
  status_.seconds = seconds;
  status_.exit_code = exit->code;
  const bool stopped =
      stopped_ || exit->code == exit_by_signal + SIGINT || exit->code == exit_by_signal + SIGTERM;
  if (status_.state == RunState::cancelled && !stopped) {
    status_.state = RunState::failed;
    const std::string said = last_lines(files_.log());
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
