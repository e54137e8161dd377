#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/app/cli/config_arguments.h"

namespace drape {

/// `drape check`: checks an experiment, or every variation of a sweep, without running it.
class CheckCommand {
 public:
  explicit CheckCommand(CLI::App& app);
  CheckCommand(const CheckCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// Returns the exit code. Throws std::runtime_error for options that a sweep does not take.
  int run(const Registry& registry) const;

 private:
  int check_experiment(const Registry& registry) const;
  int check_sweep(const Registry& registry) const;

  CLI::App* command_;
  ConfigArguments arguments_;
};

/// `drape check-energy`: compares an energy's derivatives with finite differences.
class CheckEnergyCommand {
 public:
  explicit CheckEnergyCommand(CLI::App& app);
  CheckEnergyCommand(const CheckEnergyCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// Returns the exit code. Throws std::runtime_error if the energy cannot be evaluated.
  int run(const Registry& registry) const;

 private:
  CLI::App* command_;
  std::string energy_;
};

}  // namespace drape
