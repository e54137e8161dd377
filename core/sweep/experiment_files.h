#pragma once

#include "core/sweep/sweep.h"

namespace drape {

/// One of the experiments that a sweep varies, as written.
struct ExperimentSource {
  ConfigNode root;
  std::string label;  ///< its name, where the sweep has several; else empty
  Location where;     ///< where the sweep names it
};

/// Reads the experiments that a sweep names by `base` or by `experiments`, `source` being the sweep's own
/// file. What cannot be read is appended to `errors`, with where the sweep names it.
std::vector<ExperimentSource> experiment_sources(const SweepParameters& p, const ConfigNode& source,
                                                 ConfigErrors& errors);

}  // namespace drape
