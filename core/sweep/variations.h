#pragma once

#include "core/sweep/sweep.h"

namespace drape {

/// One value that a variation gives to a path of keys, with the path's place.
struct Setting {
  std::string path;
  ConfigNode value;
  Location where;
};

/// A variation of a sweep, before it is set on the base.
struct Variation {
  std::string name;
  std::string folder;  ///< the name as a folder is called
  Location where;
  std::vector<Setting> settings;
  std::vector<std::string> methods;  ///< empty for all
  Location methods_where;
  Expectation expect;
};

/// A name as a folder is called.
std::string folder_name(std::string name);

/// The entries of a `set` map; anything else is an error.
std::vector<Setting> settings_of(const ConfigNode& set, ConfigErrors& errors);

/// Every variation that `ablation` lists, or that its grid multiplies to; one called "base" without any.
/// Names that are given twice, or would share a folder, are errors.
std::vector<Variation> variations_of(const ConfigNode& ablation, ConfigErrors& errors);

}  // namespace drape
