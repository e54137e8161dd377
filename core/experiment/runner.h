#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/experiment/checkpoint.h"
#include "core/experiment/experiment.h"

namespace drape {

class LiveView;

struct RunOptions {
  std::filesystem::path out;         ///< results folder
  std::vector<std::string> methods;  ///< which to run, in the experiment's order; empty for all
  bool overwrite = false;            ///< replace the results of an earlier run in `out`
  bool quiet = false;                ///< no progress
  bool report = true;                ///< write report.html and its pictures at the end
  double checkpoint = 5;             ///< about how often the state is saved [s]; 0 for at every step
  int first_level = 0;               ///< where every method begins
  std::string warm_started_from;  ///< what else than the scene's start is there, in words; empty if nothing
  std::function<bool()> stop;     ///< asked after every step; may be empty
  LiveView* view = nullptr;       ///< shown the run, and may stop it; may be null
};

/// A run that had begun and cannot go on, as where nothing can be written any more. Its folder says so, as
/// far as that could be written.
class RunBrokenOff : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs the methods one after another and writes everything down as it goes. Returns true when every
/// level of every method converged. What a method throws is its outcome, and the others run. Throws
/// std::runtime_error, before anything is written, for a folder or a name that cannot be used and for a
/// method that the experiment does not have, and RunBrokenOff after that.
bool run_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options);

/// Goes on with a run where its checkpoint was made, in its folder `options.out`, to the same results as if
/// it had not been interrupted. The checkpoint says what methods there are and where they begin. Throws
/// std::runtime_error where it does not fit, before anything is written, and RunBrokenOff after that.
bool resume_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options,
                       Checkpoint checkpoint);

}  // namespace drape
