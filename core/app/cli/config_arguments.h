#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/app/experiment/cloth.h"
#include "core/app/scene/scene.h"
#include "core/app/scene/scene_summary.h"

namespace drape {

/// Checks of options: an error text, or "".
using OptionCheck = std::function<std::string(const std::string&)>;
/// A check of a text; its error is "must be WHAT, not …".
OptionCheck must_be(const std::string& what, const std::function<bool(const std::string&)>& holds);
OptionCheck one_of(const std::vector<std::string>& words);
/// A check for an integer in a range.
OptionCheck integer_between(int least, int most, const std::string& what);
OptionCheck positive_integer();
OptionCheck number_of_at_least(double least);

/// Thrown for a config with faults, which nothing has been done with.
struct RefusedConfig {
  ConfigErrors errors;
  void list() const;  ///< prints the first of them on standard error
};

/// Throws RefusedConfig if there are errors.
void require_none(const ConfigErrors& errors);

/// Prints each line as a warning on standard error.
void warn_of(const std::vector<std::string>& lines);

/// An experiment file and its overrides on the command line.
struct ConfigArguments {
  std::string config;
  std::vector<std::string> sets;
  int levels = 0;
  bool allow_start_repair = false;
  bool allow_memory = false;

  /// Adds the options to a command; returns that of the file, which is required.
  CLI::Option* add_to(CLI::App& command);
  /// Adds the options but for --allow-start-repair.
  CLI::Option* add_overrides_to(CLI::App& command);
  Overrides overrides() const;
  LargeMemory large_memory() const { return allow_memory ? LargeMemory::allowed : LargeMemory::refused; }
};

/// An experiment and its scene.
struct LoadedExperiment {
  Experiment experiment;
  std::unique_ptr<Scene> scene;
  SceneSummary summary;

  /// Warns of what is not plausible. Throws RefusedConfig if the experiment is not valid.
  LoadedExperiment(const ConfigArguments& arguments, const Registry& registry);
};

}  // namespace drape
