#pragma once

#include "core/app/sweep/sweep.h"

namespace drape {

/// A value that a variation sets at a path of keys, with the path's location.
struct Setting {
  std::string path;
  ConfigNode value;
  Location where;
};

/// A variation of a sweep, before it is applied to an experiment.
struct Variation {
  std::string name;
  std::string folder;  ///< the name as a folder name
  Location where;
  std::vector<Setting> settings;
  std::vector<std::string> methods;  ///< empty for all
  Location methods_where;
  Expectation expect;
};

/// A name as a folder name.
std::string folder_name(std::string name);

/// The entries of a `set` map; appends an error for anything else.
std::vector<Setting> settings_of(const ConfigNode& set, ConfigErrors& errors);

/// The variations that `ablation` lists, or the product of its grid; a single one named "base" without any.
/// Appends an error for names that occur twice or share a folder.
std::vector<Variation> variations_of(const ConfigNode& ablation, ConfigErrors& errors);

}  // namespace drape
