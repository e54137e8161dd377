#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace drape {

class Registry;

/// The commands of `drape`. An add_… function below adds one or a few, whose options go into a struct that
/// only the command's action refers to.
class Commands {
 public:
  Commands();

  /// Adds a command; its help page has the example unless that is empty. The action returns the exit code.
  CLI::App& add(const std::string& name, const std::string& summary, const std::string& example,
                std::function<int()> action);
  /// Gives a command the option --plugin: such plugins are compiled before its action, which loads them.
  void take_plugins(CLI::App& command) { with_plugins_.push_back(&command); }
  /// Adds a command that takes plugins and loads them.
  CLI::App& add_with_plugins(const std::string& name, const std::string& summary, const std::string& example,
                             std::function<int(const Registry&)> action);

  /// Performs the command that the command line chooses; `help COMMAND` is `COMMAND --help`. Returns the exit
  /// code. Throws std::runtime_error, which names the nearest command, for a word that is none.
  int run(int argc, char** argv);

 private:
  void require_command(const std::string& word) const;

  CLI::App app_;
  std::vector<CLI::App*> with_plugins_;
  std::vector<std::string> plugin_files_;
  std::function<int()> chosen_;
};

/// Adds an option as help pages show it, "-o,--out FOLDER". It takes one word each time it is given.
template <class Value>
CLI::Option* add_option(CLI::App& command, const std::string& shown, Value& value, const std::string& help) {
  const std::size_t space = shown.find(' ');
  CLI::Option* option = command.add_option(shown.substr(0, space), value, help);
  return option->type_name(shown.substr(space + 1))->allow_extra_args(false);
}

void add_new_command(Commands& commands);
void add_check_commands(Commands& commands);  ///< check, check-energy
void add_run_command(Commands& commands);
void add_view_command(Commands& commands);
void add_export_command(Commands& commands);
void add_figures_command(Commands& commands);
void add_fabric_command(Commands& commands);
void add_fit_command(Commands& commands);
void add_report_commands(Commands& commands);  ///< report, compare, table
void add_sweep_commands(Commands& commands);   ///< sweep, and sweep-job, which its jobs on a cluster execute
void add_plugin_commands(Commands& commands);  ///< list, describe, schema
void add_reference_command(Commands& commands);

/// Makes SIGINT, SIGTERM and SIGHUP (a lost terminal) request a stop; the same one again ends the process at
/// once, unless it is SIGHUP. SIGHUP stays ignored under nohup. SIGPIPE is ignored: a run goes on where
/// nobody reads its progress.
void stop_on_signals();
/// The signal that requested the stop, 0 before.
int stop_signal();

/// For a command whose results are files: if what it printed cannot be written, as into a pipe that was
/// closed, warns, and discards that and what follows.
void allow_lost_output();

}  // namespace drape
