#pragma once

#include <string>
#include <vector>

#include "core/app/experiment/experiment.h"

namespace drape {

/// A number of an experiment that a fit scales.
struct ScaledKey {
  std::string path;
  double value;  ///< in the experiment
};

/// The numbers that paths name, each once. A path may also be that of a section with a part of its keys'
/// names: "material.bending" stands for all numbers of `material` with "bending" in their names that are not
/// defaults or, if all are, for the defaults. Appends an error for a path that names no number, with the
/// nearest one, and for 0, which no factor changes; `option` is its place.
std::vector<ScaledKey> scaled_keys(const Experiment& experiment, const std::vector<std::string>& paths,
                                   const std::string& option, ConfigErrors& errors);

}  // namespace drape
