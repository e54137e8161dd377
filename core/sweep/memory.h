#pragma once

#include <cstdint>
#include <map>

#include "core/sweep/sweep_folder.h"

namespace drape {

/// Memory that could be had without swapping [bytes]; a very large number where the kernel does not tell.
double available_memory();

/// How much memory runs will take at their peak: as much as the largest finished one with as many vertices
/// and levels, before there is one a guess by vertices.
class MemoryEstimate {
 public:
  void learn(const SweepRun& run, const RunFiles& files);  ///< from a finished run's results
  double bytes(const SweepRun& run) const;

 private:
  std::map<std::pair<double, int>, double> peaks_;  // by vertices of the finest level, levels
};

}  // namespace drape
