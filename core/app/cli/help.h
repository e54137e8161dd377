#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace drape {

/// Lists an option by its names and its type's name alone, without CLI11's marks of checks and of what it
/// needs.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
};

/// The end of every help page: the exit codes.
std::string exit_codes_help();

/// Adds an example to a command's help page.
void show_example(CLI::App& command, const std::string& example);

/// Lists a command under a heading of its own; at the end, if it is added after all others.
void for_developers(CLI::App& command);

/// The words of the command line without the program's name; `help COMMAND` becomes `COMMAND --help`.
std::vector<std::string> command_words(int argc, char** argv);

/// Throws std::runtime_error, which names the nearest command, unless the word is a command.
void require_command(const CLI::App& app, const std::string& word);

/// The message for a command line that CLI11 refuses; it names the option nearest to an unknown one.
std::string refusal(const CLI::App& app, const CLI::Error& error);

}  // namespace drape
