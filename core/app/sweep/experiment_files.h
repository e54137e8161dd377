#pragma once

#include "core/app/sweep/sweep.h"

namespace drape {

/// One of the experiments that a sweep varies, as written.
struct ExperimentSource {
  ConfigNode root;
  std::string label;  ///< its name if the sweep has several; otherwise empty
  Location where;     ///< where the sweep names it
};

/// Reads the experiments that a sweep's `base` or `experiments` names; `source` is the sweep's own file.
/// Appends an error, located in the sweep, for every one that cannot be read.
std::vector<ExperimentSource> experiment_sources(const SweepParameters& p, const ConfigNode& source,
                                                 ConfigErrors& errors);

}  // namespace drape
