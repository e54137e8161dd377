#pragma once

#include <string>

#include "core/app/files/json_file.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

/// A terminal page: a row per parameter with type, default and range, its description and source below;
/// parameters of sections are indented.
std::string describe(const Schema& schema);
std::string describe(const RegistryEntry& entry);  ///< with the entry's name, summary and library above

/// A section that several schemas have, which a page describes once.
struct SharedSection {
  Schema schema;
  std::string link;  ///< Markdown link to its description
};

/// A Markdown table for the reference page; parameters of sections appear as `section.name`. A section with
/// the name, parameters and defaults of the shared one is a single row with its link.
std::string describe_markdown(const Schema& schema, const SharedSection* shared = nullptr);
/// The table of a plugin's parameters, below a heading and its summary.
std::string describe_markdown(const RegistryEntry& entry, const SharedSection* shared = nullptr);

/// A plugin's README with its section "## Parameters" replaced; the section is appended if there was none.
std::string with_parameters(const std::string& page, const RegistryEntry& entry,
                            const SharedSection* shared = nullptr);

/// The JSON Schema of configs with this schema, for editors. With a registry, nodes that choose a plugin
/// accept the registered names and parameters; without, anything.
Json json_schema(const Schema& schema, const Registry* registry = nullptr);

/// The JSON Schema of experiments, with the registered plugins.
Json experiment_json_schema(const Registry& registry);

}  // namespace drape
