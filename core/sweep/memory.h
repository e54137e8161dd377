#pragma once

#include <map>

#include "core/sweep/sweep_folder.h"

namespace drape {

/// How much memory runs will take at their peak: as much as the largest finished one with as many vertices
/// and levels, before there is one estimated_memory.
class MemoryEstimate {
 public:
  /// Learns from every run of the sweep that has finished.
  MemoryEstimate(const Sweep& sweep, const SweepFolder& folder);
  void learn(const SweepRun& run, const RunFiles& files);  ///< from a finished run's results
  double bytes(const SweepRun& run) const;
  /// Throws std::runtime_error where one of the sweep's runs without results may take more than so many
  /// bytes.
  void require(const Sweep& sweep, const SweepFolder& folder, double machine) const;

 private:
  std::map<std::pair<double, int>, double> peaks_;  // by vertices of the finest level, levels
};

}  // namespace drape
