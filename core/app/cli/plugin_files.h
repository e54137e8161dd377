#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace drape {

/// The option --plugin FILE.cpp of the commands that load plugins.
class PluginFiles {
 public:
  void add_to(CLI::App& command);

  /// Compiles each file, unless it was compiled before, and adds it to DRAPE_PLUGIN_PATH, which the processes
  /// of a sweep inherit. Libraries are kept in $XDG_CACHE_HOME/drape or ~/.cache/drape. Throws
  /// std::runtime_error after printing what the compiler says.
  void compile() const;

 private:
  std::vector<std::string> files_;
};

}  // namespace drape
