#pragma once

#include <filesystem>
#include <string>

#include "core/plugin/config_node.h"

namespace drape {

/// Reads a file whose top is a map. Anchors and aliases cost; repeated keys are kept for Schema::read to
/// report. What is missing, unreadable, malformed or not a map is appended to `errors`, with its place,
/// and gives a null node.
ConfigNode read_yaml(const std::filesystem::path& file, ConfigErrors& errors);

/// The same from a text; places bear `name` as their file.
ConfigNode parse_yaml(const std::string& text, const std::string& name, ConfigErrors& errors);

/// The node in block style, lists of scalars on one line; reading it gives the node back.
std::string to_yaml(const ConfigNode& node);

/// Sets what is at a path of keys and of indices from 0 or types or names in lists ("metrics.0.type",
/// "energies.gravity.acceleration") to a YAML value, making maps on the way; a plugin's bare name becomes
/// `{type: name}`. Places are named "--set <path>". Returns false, with an error appended, where that cannot
/// be.
bool set_path(ConfigNode& root, const std::string& path, const std::string& value, ConfigErrors& errors);

/// The same with a value that has been read, and keeps its places; `where` is the path's own.
bool set_path(ConfigNode& root, const std::string& path, ConfigNode value, const Location& where,
              ConfigErrors& errors);

}  // namespace drape
