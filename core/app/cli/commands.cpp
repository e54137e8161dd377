#include "core/app/cli/commands.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "core/app/experiment/exit_codes.h"
#include "core/app/plugin_files/plugin_files.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/loader.h"
#include "core/kernel/version.h"

namespace drape {

namespace {

/// Lists an option by its names and its type's name alone, without CLI11's marks of checks and of what it
/// needs.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    const std::string name = CLI::Formatter::make_option_name(option, is_positional);
    return name.substr(0, name.find('{'));  // a flag of value false is "--no-report{false}"
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const bool has_value = option->get_type_size() != 0 && !option->get_positional();
    if (!has_value) return "";
    const std::string type = option->get_type_name();  // "SECONDS:NONNEGATIVE" with a check
    return " " + type.substr(0, type.find(':'));
  }
};

/// The end of every help page.
std::string exit_codes_help() {
  std::string text = "Exit codes:\n";
  for (const ExitCode& code : exit_codes)
    text += "  " + padded(std::to_string(code.code), 6) + code.description + "\n";
  return text;
}

/// The first option among the words, with its dashes and without its value; empty without one.
std::string first_option(const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (word.size() > 1 && word[0] == '-' && word != "--") return word.substr(0, word.find('='));
  return "";
}

/// The command's option that is nearest to an unknown one; empty if none is near.
std::string nearest_option(const CLI::App& command, const std::string& unknown) {
  if (!unknown.starts_with("--")) return "";
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  const std::string near = nearest_word(unknown.substr(2), names);
  return near.empty() ? "" : "--" + near;
}

/// The message for a command line that CLI11 refuses; it names the option nearest to an unknown one.
std::string refusal(const CLI::App* app, const CLI::Error& error) {
  const std::vector<CLI::App*> chosen = app->get_subcommands();
  const std::string command = chosen.empty() ? "" : " " + chosen[0]->get_name();
  // The words that no command expects, in order; the error's own text has them backwards.
  std::vector<std::string> words;
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) words = app->remaining(true);
  const std::string unknown = first_option(words);
  const std::string near = nearest_option(chosen.empty() ? *app : *chosen[0], unknown);
  std::string what = "there is no option " + excerpt(unknown);
  if (!near.empty())
    what += near == unknown ? " before the command; write it after that." : "; did you mean " + near + "?";
  if (unknown.empty()) {
    what = printable(error.what());
    if (words.size() > 1) {
      what = "The following arguments were not expected:";
      for (const std::string& word : words) what += " " + excerpt(word);
    }
  }
  return "error: " + what + (near.empty() ? "; see" : " See") + " `drape" + command + " --help`\n";
}

/// Compiles plugins, one C++ file each, and adds them to DRAPE_PLUGIN_PATH, which the processes of a sweep
/// inherit.
void compile_plugins(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    const std::string folder = compiled_plugin(file, std::cerr).parent_path().string();
    const char* before = std::getenv("DRAPE_PLUGIN_PATH");
    const bool alone = !before || !*before;
    setenv("DRAPE_PLUGIN_PATH", (alone ? folder : before + (":" + folder)).c_str(), 1);
  }
}

/// The words of the command line without the program's name; `help COMMAND` becomes `COMMAND --help`.
std::vector<std::string> command_words(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty() || words[0] != "help") return words;
  if (words.size() > 1 && words[1].starts_with("-")) return words;  // `help --help` is help's own page
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

}  // namespace

Commands::Commands() : app_("drape: progressive cloth quasistatics", "drape") {
  app_.footer(exit_codes_help());
  app_.formatter(std::make_shared<HelpFormatter>());
  app_.set_help_flag("-h,--help", "print this help and exit");
  app_.set_version_flag(
      "--version", [] { return "drape " + version() + " (" + commit() + ")"; }, "print the version and exit");
  app_.require_subcommand(1);
  app_.failure_message(refusal);
}

CLI::App& Commands::add(const std::string& name, const std::string& summary, const std::string& example,
                        std::function<int()> action) {
  CLI::App& command = *app_.add_subcommand(name, summary);
  command.footer((example.empty() ? "" : "Example:\n  " + example + "\n\n") + exit_codes_help());
  command.callback([this, action = std::move(action)] { chosen_ = action; });
  return command;
}

CLI::App& Commands::add_with_plugins(const std::string& name, const std::string& summary,
                                     const std::string& example, std::function<int(const Registry&)> action) {
  CLI::App& command = add(name, summary, example, [action = std::move(action)] {
    Registry registry;
    load_plugins(registry, plugin_directories());
    return action(registry);
  });
  take_plugins(command);
  return command;
}

void Commands::require_command(const std::string& word) const {
  std::vector<std::string> commands;
  for (const CLI::App* command : app_.get_subcommands({})) {
    if (command->get_name() == word) return;
    if (!command->get_group().empty()) commands.push_back(command->get_name());
  }
  throw std::runtime_error("there is no command \"" + excerpt(word) + "\"; " +
                           did_you_mean(word, commands, "the commands are " + joined(commands)));
}

int Commands::run(int argc, char** argv) {
  for (CLI::App* command : with_plugins_)
    add_option(*command, "--plugin FILE", plugin_files_,
               "source of a plugin, one C++ file, to be compiled and loaded; may be repeated");
  std::vector<std::string> words = command_words(argc, argv);
  if (words.empty()) {
    std::cerr << app_.help();
    return exit_bad_input;
  }
  for (const std::string& word : words)
    if (word.empty() || (word.starts_with("--") && word.find('=') == word.size() - 1))
      throw std::runtime_error((word.empty() ? "an argument" : word) +
                               " is empty, as where a variable of the shell is not set; give it a value, or "
                               "leave it out");
  if (!words[0].starts_with("-")) require_command(words[0]);
  std::reverse(words.begin(), words.end());  // as the parser takes them
  try {
    app_.parse(words);
    compile_plugins(plugin_files_);
    return chosen_();
  } catch (const CLI::ParseError& error) {
    return app_.exit(error) == 0 ? exit_done : exit_bad_input;
  }
}

}  // namespace drape
