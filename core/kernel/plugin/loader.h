#pragma once

#include <filesystem>
#include <vector>

#include "core/kernel/plugin/registry.h"

namespace drape {

/// The folder of libdrape. Throws std::runtime_error if it cannot be found.
std::filesystem::path library_directory();

/// The plugin search path: drape/ beside libdrape if it exists, then every folder of the colon-separated
/// DRAPE_PLUGIN_PATH. Throws std::runtime_error if one of the latter is not a folder.
std::vector<std::filesystem::path> plugin_directories();

/// Loads every *.so of the folders, by name, and registers its entries. Throws std::runtime_error, one line
/// with the library's path, for a library that cannot be loaded, is not a plugin, is not compatible with this
/// build (before any of its C++ is called) or repeats a name. Libraries are never unloaded.
void load_plugins(Registry& registry, const std::vector<std::filesystem::path>& directories);

/// Loads one library. Throws as load_plugins.
void load_plugin(Registry& registry, const std::filesystem::path& library);

}  // namespace drape
