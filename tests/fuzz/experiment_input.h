#pragma once

#include <string>

#include "core/app/experiment/experiment.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/plugin/loader.h"
#include "tests/fuzz/require.h"

namespace drape {

/// The plugins of the build that the targets use.
inline const Registry& fuzz_registry() {
  static const Registry* registry = [] {
    auto* all = new Registry;
    load_plugins(*all, {DRAPE_PLUGIN_DIR});
    return all;
  }();
  return *registry;
}

/// Whether reading a config would build meshes: that is slow, and geometry's part, not the readers'.
inline bool builds_meshes(const std::string& text) {
  return text.find("cages") != text.npos || text.find("subdivisions") != text.npos;
}

/// Reads an experiment, and what a run would save of it in config.yaml, which must be the same experiment.
inline void read_twice(ConfigNode source, ConfigErrors errors) {
  const auto experiment = read_experiment(std::move(source), fuzz_registry(), errors);
  require(experiment.has_value() == errors.empty(), "an experiment and no errors, or errors and none");
  for (const ConfigError& error : errors) require(!error.message.empty(), "an error says nothing");
  if (!experiment) return;
  const std::string saved = to_yaml(experiment->resolved);
  const auto again = read_experiment(parse_yaml(saved, "saved", errors), fuzz_registry(), errors);
  require(again.has_value(),
          "the saved config is refused: " + (errors.empty() ? "" : errors[0].text()) + "\n" + saved);
  const std::string saved_again = to_yaml(again->resolved);
  require(saved_again == saved, "the saved config is another one:\n" + saved + "\n" + saved_again);
}

}  // namespace drape
