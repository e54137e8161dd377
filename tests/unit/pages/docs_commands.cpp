// Commands in the pages name commands, options, targets and files that there are. The README's and those of
// docs/start are run by tests/configs/readme_commands.cpp.

#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>

#include "tests/support/pages.h"

namespace fs = std::filesystem;

namespace {

struct ShellLine {
  fs::path page;
  std::string text;
};

/// The lines of the pages' sh blocks, continued lines joined, comments cut.
std::vector<ShellLine> shell_lines() {
  std::vector<ShellLine> found;
  for (const fs::path& page : pages::documents()) {
    bool inside = false, continued = false;
    for (std::string line : pages::lines_of(page)) {
      if (line.starts_with("```")) {
        inside = !inside && line.starts_with("```sh");
        continue;
      }
      if (!inside) continue;
      line = line.substr(0, std::min(line.find(" #"), line.find("# ") == 0 ? 0 : line.npos));
      const bool more = line.ends_with("\\");
      if (more) line.pop_back();
      if (continued)
        found.back().text += line;
      else
        found.push_back({page, line});
      continued = more;
    }
  }
  return found;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// The sources of the `drape` command.
std::string cli_sources() {
  std::string all;
  for (const fs::path& file : pages::below({"core/app/cli"}, {".cpp", ".h"})) all += pages::text_of(file);
  return all;
}

}  // namespace

TEST_CASE("commands in the pages name commands, options and files that there are") {
  const fs::path root = folders::source();
  const std::string cli = cli_sources(), makefile = pages::text_of(root / "Makefile");
  // An option's long name stands alone, after its short name or after a flag's negation. It ends its
  // declaration, or a word in capitals for its value does.
  const auto declares = [&](const std::string& name) {
    for (const char before : {'"', ',', '!'})
      for (std::size_t at = cli.find(before + name); at != cli.npos; at = cli.find(before + name, at + 1)) {
        const std::string end = cli.substr(at + 1 + name.size(), 2);
        if (end[0] == '"' || (end[0] == ' ' && end[1] >= 'A' && end[1] <= 'Z')) return true;
      }
    return name.size() == 2 && cli.find("\"" + name + ",--") != cli.npos;
  };
  int drape_commands = 0, make_targets = 0, files = 0;
  for (const ShellLine& line : shell_lines()) {
    INFO(line.page.string() << ": " << line.text);
    const std::vector<std::string> words = words_of(line.text);
    if (words.empty()) continue;
    if (words[0] == "drape" || words[0].ends_with("/drape")) {
      ++drape_commands;
      REQUIRE(words.size() > 1);
      if (words[1][0] != '-') CHECK(cli.find("\"" + words[1] + "\"") != cli.npos);
      for (const std::string& word : words)
        if (word.starts_with("-") && word != "--help") CHECK(declares(word.substr(0, word.find('='))));
    }
    if (words[0] == "make")
      for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i].find('=') != std::string::npos) continue;
        CHECK(makefile.find("\n" + words[i] + ":") != makefile.npos);
        ++make_targets;
      }
    for (const std::string& word : words)
      if (word.starts_with("configs/") && word.find('*') == word.npos) {
        CHECK(fs::exists(root / word.substr(0, word.find(';'))));
        ++files;
      }
  }
  CHECK(drape_commands > 40);
  CHECK(make_targets > 15);
  CHECK(files > 10);
}

TEST_CASE("docs/reference/command.md lists every command") {
  const std::string page = pages::text_of(folders::source() / "docs/reference/command.md");
  const std::string cli = cli_sources();
  const std::regex command("commands\\s*\\.add(?:_with_plugins)?\\(\\s*\"([a-z0-9-]+)\"");
  int commands = 0;
  for (std::sregex_iterator it(cli.begin(), cli.end(), command), end; it != end; ++it) {
    const std::string name = (*it)[1];
    if (name == "sweep-job") continue;  // hidden: a cluster's jobs run it
    INFO(name);
    CHECK(page.find("| `drape " + name) != std::string::npos);
    ++commands;
  }
  CHECK(commands >= 10);
}
