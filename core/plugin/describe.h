#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/plugin/registry.h"

namespace drape {

/// For the terminal: a row for each parameter with type, default and range, its description and source below;
/// the parameters of sections are indented.
std::string describe(const Schema& schema);
std::string describe(const RegistryEntry& entry);  ///< the same after the entry's name, summary and library

/// For the reference page: a Markdown table, sections' parameters as `section.name`.
std::string describe_markdown(const Schema& schema);
std::string describe_markdown(const RegistryEntry& entry);  ///< the same under a heading and the summary

/// A plugin's own page with what follows its heading "## Parameters", up to the next one, made anew; the
/// heading comes last where there was none.
std::string with_parameters(const std::string& page, const RegistryEntry& entry);

/// The node as JSON: a plain scalar that spells a number or a boolean is one.
nlohmann::ordered_json json_value(const ConfigNode& node);

/// For editors: the JSON Schema of configs with this schema. With a registry, nodes that choose a plugin
/// allow the names and parameters of those in it; without, anything.
nlohmann::ordered_json json_schema(const Schema& schema, const Registry* registry = nullptr);

/// For editors: a map of names to plugins of a kind, as an experiment's methods are; without a `type` the
/// name is the plugin's.
nlohmann::ordered_json named_plugins_schema(const std::string& kind, const Registry& registry);

}  // namespace drape
