#include "core/app/cli/help.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/experiment/exit_codes.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

/// The words that no command expects, in order; empty for other errors. The error's own text has them
/// backwards.
std::vector<std::string> unexpected_words(const CLI::App& app, const CLI::Error& error) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) return {};
  return app.remaining(true);
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

}  // namespace

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool is_positional) const {
  const std::string name = CLI::Formatter::make_option_name(option, is_positional);
  return name.substr(0, name.find('{'));  // a flag of value false is "--no-report{false}"
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const bool has_value = option->get_type_size() != 0 && !option->get_positional();
  if (!has_value) return "";
  const std::string type = option->get_type_name();  // "SECONDS:NONNEGATIVE" with a check
  return " " + type.substr(0, type.find(':'));
}

std::string exit_codes_help() {
  std::string text = "Exit codes:\n";
  for (const ExitCode& code : exit_codes)
    text += "  " + padded(std::to_string(code.code), 6) + code.description + "\n";
  return text;
}

void show_example(CLI::App& command, const std::string& example) {
  command.footer("Example:\n  " + example + "\n\n" + exit_codes_help());
}

void for_developers(CLI::App& command) { command.group("For developers of drape"); }

std::vector<std::string> command_words(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty() || words[0] != "help") return words;
  if (words.size() > 1 && words[1].starts_with("-")) return words;  // `help --help` is help's own page
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

void require_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return;
    if (!command->get_group().empty()) commands.push_back(command->get_name());
  }
  const std::string near = nearest_word(word, commands);
  throw std::runtime_error(
      "there is no command \"" + excerpt(word) + "\"; " +
      (near.empty() ? "the commands are " + joined(commands) : "did you mean \"" + near + "\"?"));
}

std::string refusal(const CLI::App& app, const CLI::Error& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::string command = chosen.empty() ? "" : " " + chosen[0]->get_name();
  const std::vector<std::string> words = unexpected_words(app, error);
  const std::string unknown = first_option(words);
  const std::string near = nearest_option(chosen.empty() ? app : *chosen[0], unknown);
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

}  // namespace drape
