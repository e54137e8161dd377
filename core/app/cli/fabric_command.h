#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace drape {

/// `drape fabric`: what a laboratory would measure of a fabric of a table.
class FabricCommand {
 public:
  explicit FabricCommand(CLI::App& app);
  FabricCommand(const FabricCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// Returns the exit code.
  int run() const;

 private:
  CLI::App* command_;
  std::string name_, file_;
};

}  // namespace drape
