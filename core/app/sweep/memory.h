#pragma once

#include <map>

#include "core/app/sweep/sweep_folder.h"

namespace drape {

/// Estimates the peak memory of runs: that of the largest finished run with as many vertices and levels, or
/// estimated_memory without one.
class MemoryEstimate {
 public:
  /// Learns from every run of the sweep that has finished.
  MemoryEstimate(const Sweep& sweep, const SweepFolder& folder);
  void learn(const SweepRun& run, const RunFiles& files);  ///< from a finished run's results
  double bytes(const SweepRun& run) const;
  /// Throws std::runtime_error if one of the sweep's runs without results may need more than so many bytes.
  void require(const Sweep& sweep, const SweepFolder& folder, double machine) const;

 private:
  std::map<std::pair<double, int>, double> peaks_;  // by vertices of the finest level, levels
};

}  // namespace drape
