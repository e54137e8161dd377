#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/experiment.h"
#include "core/app/experiment/scene_summary.h"
#include "core/app/experiment/size_estimate.h"

namespace drape {

/// Validates a positive integer option: an error text, or "".
std::string positive_integer(const std::string& text);

/// The same for a number of at least `least`.
std::function<std::string(const std::string&)> number_of_at_least(double least);

/// Prints the errors and returns the exit code.
int report_errors(const ConfigErrors& errors);

/// Prints each line as a warning on standard error.
void warn_of(const std::vector<std::string>& lines);

/// An experiment file and its overrides on the command line.
struct ConfigArguments {
  std::string config;
  std::vector<std::string> sets;
  int levels = 0;
  bool allow_start_repair = false;
  bool allow_memory = false;
  CLI::Option* config_option = nullptr;

  void add_to(CLI::App& command);
  Overrides overrides() const;
  LargeMemory large_memory() const { return allow_memory ? LargeMemory::allowed : LargeMemory::refused; }
};

/// An experiment and its scene; both empty, with errors printed, if they are not valid. Warns of what is not
/// plausible.
struct Loaded {
  std::optional<Experiment> experiment;
  std::unique_ptr<Scene> scene;
  SceneSummary summary;
  int exit_code = 0;

  Loaded(const ConfigArguments& arguments, const Registry& registry);

 private:
  void repair(ConfigErrors& errors);
};

}  // namespace drape
