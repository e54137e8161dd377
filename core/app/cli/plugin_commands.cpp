// The commands that show what can be written: list, describe, schema and reference.

#include <iostream>

#include "core/app/cli/commands.h"
#include "core/app/experiment/describe.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment.h"
#include "core/app/experiment/pattern_parameters.h"
#include "core/app/files/json_file.h"
#include "core/app/sweep/sweep.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

namespace {

int list(const std::string& asked, const Registry& registry) {
  const std::vector<std::string>& kinds = plugin_kinds();
  if (!asked.empty() && !is_one_of(asked, kinds))
    throw std::runtime_error("there is no kind \"" + excerpt(asked) + "\"; the kinds are " + joined(kinds));
  for (const std::string& kind : kinds) {
    if (!asked.empty() && kind != asked) continue;
    std::cout << kind << "\n";
    for (const RegistryEntry* entry : registry.of_kind(kind))
      std::cout << "  " << padded(entry->name, 24) << " " << printable(entry->summary) << "\n";
  }
  return exit_done;
}

int describe_plugin(const std::string& name, const Registry& registry) {
  std::vector<std::string> names = {"experiment", "sweep"}, found;
  if (name == names[0]) found.push_back(describe(schema_of<ExperimentParameters>("experiment")));
  if (name == names[1]) found.push_back(describe_sweep());
  for (const auto& entry : registry.entries()) {
    names.push_back(entry->name);
    if (entry->name == name) found.push_back(describe(*entry));
  }
  for (std::size_t k = 0; k < found.size(); ++k)
    std::cout << (k > 0 ? "\n" : "") << printable_lines(found[k]);
  if (!found.empty()) return exit_done;
  throw std::runtime_error("no plugin is called \"" + excerpt(name) + "\"; " +
                           did_you_mean(name, names, "`drape list` names them all"));
}

int print_schema(const std::string& of, const Registry& registry) {
  std::cout << json_text(of == "sweep" ? sweep_json_schema() : experiment_json_schema(registry), 2) << "\n";
  return exit_done;
}

int reference(const Registry& registry) {
  ReferencePage page{schema_of<NewtonParameters>("newton"), "[Newton](#newton)", {}};
  std::cout << "# Configuration reference\n\n"
               "```sh\n"
               "drape describe experiment              # a table of this page, in the terminal\n"
               "drape describe pcs                     # a plugin's\n"
               "drape run my_drape.yaml --set newton.force_tolerance=1e-4 --set contact.shapes.dhat=2e-3\n"
               "```\n\n"
               "Made by `drape reference`; do not edit.\n\n## Experiment\n\n"
            << describe_markdown(schema_of<ExperimentParameters>("experiment"), &page)
            << "\n## Newton\n\nThe section `newton` of an experiment applies to every method. A method's own "
               "`newton` takes precedence, key by key.\n\n"
            << describe_markdown(page.shared);
  for (const std::string& kind : plugin_kinds()) {
    std::cout << "\n## Kind: " << kind << "\n";
    std::vector<std::string> plain;
    for (const RegistryEntry* entry : registry.of_kind(kind))
      if (entry->schema.parameters.empty())
        plain.push_back("`" + entry->name + "`");
      else
        std::cout << "\n" << describe_markdown(*entry, page);
    if (!plain.empty()) std::cout << "\nWithout parameters: " << joined(plain) << ".\n";
  }
  std::cout << "\n## Sewing pattern\n\n" << describe_pattern_markdown();
  std::cout << "\n## Sweep\n\n" << describe_sweep_markdown();
  return exit_done;
}

}  // namespace

void add_plugin_commands(Commands& commands) {
  const auto kind = std::make_shared<std::string>();
  commands
      .add_with_plugins("list", "list plugins", "drape list energy",
                        [kind](const Registry& registry) { return list(*kind, registry); })
      .add_option("kind", *kind, "energy, refiner, contact, solver or metric (default: all)");
  const auto name = std::make_shared<std::string>();
  commands
      .add_with_plugins("describe", "show a plugin's parameters (or `experiment`'s, `sweep`'s)",
                        "drape describe strain_limit",
                        [name](const Registry& registry) { return describe_plugin(*name, registry); })
      .add_option("name", *name, "name of the plugin")
      ->required();
  const auto of = std::make_shared<std::string>("experiment");
  commands
      .add_with_plugins("schema", "print the JSON Schema of experiments (or sweeps), for editors",
                        "drape schema > experiment.schema.json",
                        [of](const Registry& registry) { return print_schema(*of, registry); })
      .add_option("kind", *of, "experiment (default) or sweep")
      ->check(CLI::IsMember({"experiment", "sweep"}));
}

void add_reference_command(Commands& commands) {
  commands
      .add_with_plugins("reference", "print the configuration reference (Markdown)",
                        "drape reference > docs/reference/configuration.md",
                        [](const Registry& registry) { return reference(registry); })
      .group("For developers of drape");
}

}  // namespace drape
