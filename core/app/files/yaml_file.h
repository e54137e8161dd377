#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/kernel/plugin/config_node.h"

namespace drape {

/// Reads a file whose top level is a map. Anchors and aliases are supported; Schema::read reports repeated
/// keys. Returns a null node, with an error and its location appended, for a missing, unreadable or malformed
/// file.
ConfigNode read_yaml(const std::filesystem::path& file, ConfigErrors& errors);

/// Reads a text as read_yaml does a file; locations have `name` as their file.
ConfigNode parse_yaml(const std::string& text, const std::string& name, ConfigErrors& errors);

/// The node in block style, lists of scalars on one line; parse_yaml gives the node back.
std::string to_yaml(const ConfigNode& node);

/// The YAML value of an option of the command line, which is its location; empty, with an error appended, if
/// it is not YAML.
std::optional<ConfigNode> value_of_option(const std::string& text, const std::string& option,
                                          ConfigErrors& errors);

/// Gives a node and all within it, keys too, one location.
void set_places(ConfigNode& node, const Location& where);

/// Sets the node at a path to a value, which keeps its locations; `where` is the location of the path. A path
/// consists of keys and, in lists, of indices from 0, types or names ("metrics.0.type",
/// "energies.gravity.acceleration"). Missing maps are made; a plugin's bare name becomes `{type: name}`.
/// Returns false, with an error appended, if the path does not exist.
bool set_path(ConfigNode& root, const std::string& path, ConfigNode value, const Location& where,
              ConfigErrors& errors);
/// Sets a value in a resolved experiment, in which a path of the program's own cannot fail.
void set_path(ConfigNode& resolved, const std::string& path, ConfigNode value);

}  // namespace drape
