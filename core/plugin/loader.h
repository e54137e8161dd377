#pragma once

#include <filesystem>
#include <vector>

#include "core/plugin/registry.h"

namespace drape {

/// Where plugins are looked for: <folder of the running command>/../lib/drape if it exists, then every
/// folder of the colon-separated DRAPE_PLUGIN_PATH. Throws if one of the latter is not a folder.
std::vector<std::filesystem::path> plugin_directories();

/// Loads every *.so of the folders, sorted by name in each, and registers what it names. Throws
/// std::runtime_error, one line with the library's path, for one that cannot be loaded, is no plugin, does
/// not fit this build (before any C++ of it is called) or repeats a name. Libraries stay loaded for good.
void load_plugins(Registry& registry, const std::vector<std::filesystem::path>& directories);

}  // namespace drape
