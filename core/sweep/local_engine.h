#pragma once

#include <functional>

#include "core/sweep/sweep_folder.h"

namespace drape {

struct LocalOptions {
  int workers = 1;
  int threads = 1;             ///< of each run
  double memory_limit = 0;     ///< of all runs together [bytes]; 0: what is available
  bool report = false;         ///< write each run's report
  double time_limit = 0;       ///< of each run [s]; 0: none
  std::function<bool()> stop;  ///< asked all the time
};

/// Runs these of the sweep's runs, several at a time, each in a process of its own, keeping sweep.json up to
/// date and telling standard error how it goes. A run that fails does not stop the others. On `stop`, the
/// runs save what they have and end, and no more are started.
void run_locally(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const LocalOptions& options);

/// "3.2 s", "4 min", "1.5 h"
std::string duration_text(double seconds);

}  // namespace drape
