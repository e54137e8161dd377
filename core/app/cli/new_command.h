#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace drape {

/// `drape new`: writes a commented first experiment.
class NewCommand {
 public:
  explicit NewCommand(CLI::App& app);
  NewCommand(const NewCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// Returns the exit code. Throws std::runtime_error if the file exists, or cannot be made, or its name
  /// cannot be an experiment's.
  int run() const;

 private:
  CLI::App* command_;
  std::string file_ = "first.yaml";
};

}  // namespace drape
