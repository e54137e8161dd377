#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/app/report/run_export.h"

namespace drape {

/// Adds the option --width, the width of pictures [pixels], to a command.
void add_picture_width(CLI::App& command, std::optional<int>& width, const std::string& help);

/// `drape export`: writes states of a run for other programs.
class ExportCommand {
 public:
  explicit ExportCommand(CLI::App& app);
  ExportCommand(const ExportCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// Returns the exit code.
  int run() const;

 private:
  CLI::App* command_;
  std::string folder_, file_;
  ExportOptions options_;
};

}  // namespace drape
