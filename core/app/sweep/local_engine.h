#pragma once

#include <functional>

#include "core/app/sweep/sweep_folder.h"

namespace drape {

struct LocalOptions {
  int workers = 1;
  int threads = 1;             ///< of each run
  double memory_limit = 0;     ///< of all runs together [bytes]; 0: the available memory
  bool report = false;         ///< write each run's report
  bool quiet = false;          ///< say nothing of runs that end well
  double time_limit = 0;       ///< of each run [s]; 0: none
  std::function<bool()> stop;  ///< polled
};

/// Executes the missing runs of a sweep, several at a time, each in its own process. Keeps sweep.json up to
/// date and reports progress on standard error. A failed run does not stop the others. On `stop`, running
/// ones save their state and exit, and no further ones start.
void run_locally(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const LocalOptions& options);

/// "3.2 s", "4 min", "1.5 h"
std::string duration_text(double seconds);

}  // namespace drape
