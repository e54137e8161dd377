#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"

namespace drape {

class LiveView;

struct RunOptions {
  std::filesystem::path out;         ///< results folder
  std::vector<std::string> methods;  ///< which to run, in the experiment's order; empty for all
  bool overwrite = false;            ///< replace the results of an earlier run in `out`
  bool quiet = false;                ///< no progress
  bool report = true;                ///< write report.html and its pictures at the end
  std::function<bool()> stop;        ///< asked after every step; may be empty
  LiveView* view = nullptr;          ///< shown the run, and may stop it; may be null
};

/// Runs the methods one after another and writes everything down as it goes. Returns true when every
/// level of every method converged. Throws std::runtime_error for a folder that cannot be used and for
/// a method that the experiment does not have, before anything is written.
bool run_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options);

}  // namespace drape
