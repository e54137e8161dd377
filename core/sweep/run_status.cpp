#include "core/sweep/run_status.h"

#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/mesh/file.h"
#include "core/model/solver.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* words[] = {"waiting", "running", "converged", "ended", "failed", "cancelled"};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The last few lines of what a run said.
std::string last_lines(const std::filesystem::path& file) {
  std::string text = text_of_file(file);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::size_t from = text.size();
  for (int line = 0; line < 5 && from != std::string::npos && from > 0; ++line)
    from = text.rfind('\n', from - 1);
  return from == std::string::npos || from == 0 ? text : text.substr(from + 1);
}

/// Marks the run as begun, and removes what an earlier start of it has left.
RunStatus begin(const RunFiles& files, int threads) {
  const int starts = read_status(files).starts;
  RunStatus status{RunState::running, "", 0, 0, starts + 1, threads};
  write_status(files, status);
  if (starts > 0) std::filesystem::remove_all(files.folder);
  std::filesystem::remove(files.log());
  return status;
}

std::vector<std::string> command(const RunFiles& files, int threads, bool report) {
  std::vector<std::string> all = {own_program(),   "run",     files.config(), "--out",
                                  files.folder,    "--quiet", "--threads",    std::to_string(threads),
                                  "--allow-memory"};  // the sweep has seen to it
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
  try {
    const Json json = Json::parse(text);
    RunStatus status;
    const std::string word = json.at("status");
    const auto* found = std::find(std::begin(words), std::end(words), word);
    if (found == std::end(words)) throw std::runtime_error("no status is called \"" + word + "\"");
    status.state = RunState(found - words);
    status.error = json.at("error");
    status.exit_code = json.at("exit_code");
    status.seconds = json.at("seconds");
    status.starts = json.at("starts");
    status.threads = json.at("threads");
    return status;
  } catch (const std::exception& error) {
    throw std::runtime_error(files.status().string() + ": is not a run's status (" + error.what() +
                             "); remove it and the run's folder");
  }
}

void write_status(const RunFiles& files, const RunStatus& status) {
  make_folder(files.folder.parent_path());
  write_file(files.status(), status.json().dump(1) + "\n");
}

RunStatus settled(const RunFiles& files, RunStatus status) {
  if (status.state != RunState::running) return status;
  status.state = RunState::cancelled;
  const Json results = Json::parse(text_of_file(files.folder / "results.json"), nullptr, false);
  if (!results.is_object() || !results.value("complete", false)) return status;
  status.state = RunState::converged;
  status.seconds = 0;
  for (const auto& [name, method] : results.at("methods").items()) {
    if (!has_converged(method.value("status", ""))) status.state = RunState::ended;
    status.seconds += method.value("seconds", 0.0);
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
  status_ = settled(files_, status_);
  status_.seconds = seconds;
  status_.exit_code = exit->code;
  const bool stopped =
      stopped_ || exit->code == exit_by_signal + SIGINT || exit->code == exit_by_signal + SIGTERM;
  if (status_.state == RunState::cancelled && !stopped) {
    status_.state = RunState::failed;
    const std::string said = last_lines(files_.log());
    if (too_slow_) {
      status_.exit_code = exit_too_slow;
      status_.error = "was ended since it took longer than the sweep's time_limit";
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
