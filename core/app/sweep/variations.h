#pragma once

#include "core/app/sweep/sweep.h"
#include "core/kernel/plugin/declaration.h"

namespace drape {

/// A variation of a sweep's experiments, before it is applied to one of them.
struct Variation {
  std::string name;
  ConfigNode set;  ///< a map from paths of keys to values
  std::optional<int> levels;
  std::vector<std::string> methods;  ///< empty for all
  Expectation expect;
  static void declare(Declaration<Variation>& d);

  Location where, methods_where;  ///< of the name and of the methods
};

/// A name as a folder name.
std::string folder_name(std::string name);

/// Appends the faults of a map from paths of keys to values.
void check_settings(const ConfigNode& set, ConfigErrors& errors);

/// The variations that `ablation` lists, or the product of its grid; a single one named "base" without any.
/// Appends an error for names that occur twice or share a folder.
std::vector<Variation> variations_of(const ConfigNode& ablation, ConfigErrors& errors);

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
