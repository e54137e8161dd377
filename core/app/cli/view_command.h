#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace drape {

/// `drape view`: opens the report of a run or a sweep in a browser, and writes it if it is missing or older
/// than the results.
class ViewCommand {
 public:
  explicit ViewCommand(CLI::App& app);
  ViewCommand(const ViewCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// Returns the exit code. Without a display or without xdg-open it prints the page's address instead.
  int run() const;

 private:
  CLI::App* command_;
  std::string folder_;
};

}  // namespace drape
