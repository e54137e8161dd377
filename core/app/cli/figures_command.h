#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace drape {

/// `drape figures`: a paper's plots and tables, by the Python package `drape`.
class FiguresCommand {
 public:
  explicit FiguresCommand(CLI::App& app);
  FiguresCommand(const FiguresCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// Becomes python3, whose exit code is the command's. Throws std::runtime_error for a folder without
  /// results, and if python3 does not start.
  int run() const;

 private:
  CLI::App* command_;
  std::string folder_, out_;
};

}  // namespace drape
