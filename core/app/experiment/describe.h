#pragma once

#include <map>
#include <string>

#include "core/app/files/json_file.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

/// A terminal page: a row per parameter with type, default and range, its description and source below;
/// parameters of sections are indented.
std::string describe(const Schema& schema);
std::string describe(const RegistryEntry& entry);  ///< with the entry's name, summary and library above

/// What the tables of a reference page share, so that it describes each thing once.
struct ReferencePage {
  Schema shared;     ///< a section that several schemas have, which the page describes apart
  std::string link;  ///< Markdown link to that description
  std::map<std::string, std::string> places;  ///< where it describes a row, by name and other cells
};

/// A Markdown table; parameters of sections appear as `section.name`. A section with the name, parameters and
/// defaults of the shared one is a single row with its link; several keys that a section above has alike are
/// a row that names it.
std::string describe_markdown(const Schema& schema, ReferencePage* page = nullptr,
                              const std::string& plugin = "");
/// The table of a plugin's parameters, below a heading and its summary.
std::string describe_markdown(const RegistryEntry& entry, ReferencePage& page);

/// The JSON Schema of configs with this schema, for editors. With a registry, nodes that choose a plugin
/// accept the registered names and parameters; without, anything.
Json json_schema(const Schema& schema, const Registry* registry = nullptr);

/// The JSON Schema of experiments, with the registered plugins.
Json experiment_json_schema(const Registry& registry);

}  // namespace drape
