#pragma once

#include <csignal>
#include <filesystem>
#include <string>

#include "core/app/experiment/exit_codes.h"
#include "core/app/files/json_file.h"
#include "core/app/sweep/process.h"
#include "core/app/sweep/sweep.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

/// `not_converged` has complete results of which some did not converge; `failed` has none; `cancelled` was
/// stopped, or its machine was.
enum class RunState { pending, running, converged, not_converged, failed, cancelled };
const char* to_string(RunState state);

/// The status of one run, in a file of its own: no two machines write the same file.
struct RunStatus {
  RunState state = RunState::pending;
  std::string error;
  int exit_code = 0;
  double seconds = 0;  ///< in all starts that it was resumed in
  int starts = 0;
  int threads = 0;

  /// The run refused its input, before any computation.
  bool refused() const { return state == RunState::failed && exit_code == exit_bad_input; }
  bool has_results() const { return state == RunState::converged || state == RunState::not_converged; }
  Json json() const;
};

/// One run's files in a sweep's folder: results inside, the others beside it.
struct RunFiles {
  std::filesystem::path folder;
  std::filesystem::path results() const { return folder / "results.json"; }
  std::filesystem::path config() const { return folder.string() + ".yaml"; }
  std::filesystem::path status() const { return folder.string() + ".status.json"; }
  std::filesystem::path lock() const { return folder.string() + ".lock"; }
  std::filesystem::path log() const { return folder.string() + ".log"; }  ///< its output
};

/// The status in the file, pending without one. Throws std::runtime_error for a file that is not a status.
RunStatus read_status(const RunFiles& files);
void write_status(const RunFiles& files, const RunStatus& status);

/// What to do about a value of the wrong kind in a run's results.
inline constexpr const char* remedy_of_results = "remove the run's folder, and the sweep runs it again";
/// The status of a run by its results. One that had begun has complete ones after `drape run --resume`;
/// without any it has failed, or is cancelled if it is marked as running but is not. One whose results were
/// damaged since has failed, one whose results are gone is pending.
RunStatus resolve_status(const RunFiles& files, RunStatus status);

/// A `drape run` of the files' config; updates the status at its beginning and end.
class RunProcess {
 public:
  /// Marks the run as running and starts it: from its last checkpoint if it was cut with as many threads,
  /// otherwise from the beginning, without the files of an earlier start. A run that takes longer than
  /// `time_limit` [s] is ended; 0: none.
  RunProcess(RunFiles files, const SweepOptions& options, double time_limit);

  bool ended();  ///< updates the status the first time that it is true
  void stop() { stopped_ = true, process_.signal(SIGINT); }
  const RunStatus& status() const { return status_; }
  std::int64_t resident_bytes() const { return process_.resident_bytes(); }

 private:
  RunFiles files_;
  bool resumes_;
  RunStatus status_;
  Stopwatch clock_;  // of all starts that it resumes
  double time_limit_;
  Process process_;
  bool stopped_ = false, too_slow_ = false;
};

}  // namespace drape
