#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/app/report/run_collection.h"
#include "core/app/run/progress.h"
#include "core/app/run/saved_run.h"
#include "core/app/scene/scene.h"

namespace drape {

class LiveView;

struct RunOptions {
  std::filesystem::path out;                  ///< results folder
  std::vector<std::string> methods;           ///< methods to run; empty for all
  bool overwrite = false;                     ///< replace the results of an earlier run in `out`
  Verbosity verbosity = Verbosity::progress;  ///< what standard error shows
  bool report = true;                         ///< write report.html and its pictures at the end
  /// Measure pairs of states and errors at once. Otherwise a run with nothing to compare with, of one method
  /// and no reference, leaves them and its pictures to measured_runs.
  bool measure = true;
  double checkpoint = 5;          ///< checkpoint interval [s]; 0 saves at every step
  int first_level = 0;            ///< first level of every method
  std::string warm_started_from;  ///< origin of a warm start, in words; empty without one
  std::function<bool()> stop;     ///< polled after every step; may be empty
  std::function<void(const std::string&)> method_started;  ///< called as a method begins; may be empty
  Observer* observer = nullptr;  ///< sees every event after it is recorded; may be null
  LiveView* view = nullptr;      ///< shows the run and may stop it; may be null
};

/// A run was aborted after it had begun, as on a full disk. Its folder records the cause if that is possible.
class RunAborted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs the methods one after another and records their results. Returns true if every level of every method
/// succeeded without intersections. A method that throws counts as failed, and the others run. Throws
/// std::runtime_error, before it writes, for a folder or a name that cannot be used and for an unknown
/// method; RunAborted after that.
bool run_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options);

/// Resumes a run from its checkpoint in its folder, which stays locked meanwhile. The results are those of an
/// uninterrupted run, bit for bit. The checkpoint determines methods and first level; `options.out` is not
/// used. Throws std::runtime_error, before it writes, if the checkpoint does not fit; RunAborted after that.
bool resume_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options,
                       InterruptedRun interrupted);

/// Reads runs and sweeps, as read_runs, after measuring what runs of one method have left: once, since the
/// results are stored. `plugins` is called if there is such a run. One that cannot be measured, as in a
/// folder that is not writable, appends a warning.
RunCollection measured_runs(const std::vector<std::filesystem::path>& folders,
                            const std::function<const Registry&()>& plugins,
                            std::vector<std::string>& warnings);

}  // namespace drape
