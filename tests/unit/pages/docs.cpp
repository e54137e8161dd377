// The pages of docs/ and beside the sources: links, pictures, messages, codes and commands that they speak
// of. Commands of the README and of docs/start are run by tests/configs/readme_commands.cpp.

#include <catch2/catch.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "core/app/experiment/exit_codes.h"
#include "tests/unit/pages/source_texts.h"

namespace fs = std::filesystem;

namespace {

/// The fragment that a heading is reached by: letters, digits, '-' and '_' in lower case, spaces as '-'.
std::string fragment_of(const std::string& heading) {
  std::string fragment;
  for (const unsigned char c : heading)
    if (c == ' ')
      fragment += '-';
    else if (std::isalnum(c) || c == '-' || c == '_' || c >= 0x80)
      fragment += static_cast<char>(std::tolower(c));
  return fragment;
}

std::set<std::string> fragments_of(const fs::path& page) {
  std::set<std::string> fragments;
  bool code = false;
  for (const std::string& line : pages::lines_of(page)) {
    if (line.starts_with("```")) code = !code;
    const std::size_t level = line.find_first_not_of('#');
    if (!code && level != line.npos && level > 0 && line[level] == ' ')
      fragments.insert(fragment_of(line.substr(level + 1)));
  }
  return fragments;
}

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

/// The documents, and the pages beside the sources.
std::vector<fs::path> pages_and_readmes() {
  std::vector<fs::path> found = pages::below({"core", "plugins", "third_party", "benchmarks"}, {".md"});
  for (const fs::path& page : pages::documents()) found.push_back(page);
  return found;
}

/// The sources of the `drape` command.
std::string cli_sources() { return texts_of_files(pages::below({"core/app/cli"}, {".cpp", ".h"})); }

}  // namespace

TEST_CASE("the pages have every exit code, and speak of messages that there are") {
  const std::string codes = source_text("docs/reference/exit-codes.md");
  for (const drape::ExitCode& code : drape::exit_codes)
    CHECK_THAT(codes,
               Catch::Contains("\n| `" + std::to_string(code.code) + "` | " + code.description + " |\n"));
  // String literals that go on in the next line are joined.
  const std::string code = std::regex_replace(
      texts_of_files(pages::below({"core", "plugins"}, {".cpp", ".h"})), std::regex("\"\\s*\n\\s*\""), "");
  const auto rows = matches_in(source_text("docs/guide/troubleshooting.md"), "\n\\| `([^`]+)` \\|");
  for (const auto& row : rows) {
    INFO(row[1]);
    CHECK(code.find(row[1]) != std::string::npos);
  }
  CHECK(rows.size() > 20);
}

TEST_CASE("every link between the pages leads somewhere") {
  int links = 0, fragments = 0;
  for (const fs::path& page : pages_and_readmes())
    for (const auto& link :
         matches_in(pages::text_of(page), "(?:\\]\\(|src(?:set)?=\")([^)#\"]*)(#([^)]*))?[)\"]")) {
      const std::string &target = link[1], &fragment = link[3];
      if (target.starts_with("http")) continue;
      const fs::path file = target.empty() ? page : page.parent_path() / target;
      INFO(page.string() << " links to " << link[0]);
      CHECK(fs::exists(file));
      ++links;
      if (fragment.empty() || file.extension() != ".md" || !fs::exists(file)) continue;
      CHECK(fragments_of(file).count(fragment) == 1);
      ++fragments;
    }
  CHECK(links > 200);
  CHECK(fragments > 10);
}

TEST_CASE("pages that sources and scripts name are there, with the sections that they name") {
  const fs::path root = folders::source();
  int names = 0, sections = 0;
  std::vector<fs::path> files = {root / "Makefile"};
  for (const char* folder : {"core", "plugins", "tests", "benchmarks", "configs", "third_party"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && entry.file_size() < 200000) files.push_back(entry.path());
  for (const fs::path& file : files)
    for (const auto& name :
         matches_in(pages::text_of(file), "(docs/[A-Za-z0-9/_-]+\\.md)(,? sections? ([0-9]))?")) {
      INFO(file.string() << " names " << name[0]);
      REQUIRE(fs::exists(root / name[1]));
      ++names;
      if (name[3].empty()) continue;
      CHECK(source_text(name[1]).find("\n## " + name[3] + ". ") != std::string::npos);
      ++sections;
    }
  CHECK(names > 40);
  CHECK(sections > 10);
}

TEST_CASE("docs/README.md is the map of every page, and a page shows every picture") {
  const std::string map = source_text("docs/README.md"), all = texts_of_files(pages::documents());
  for (const fs::path& file : pages::below({"docs"}, {".md", ".png", ".webp"})) {
    const std::string name = fs::relative(file, folders::source() / "docs").generic_string();
    INFO(name);
    if (name == "README.md") continue;
    const bool found = file.extension() == ".md"
                           ? map.find("](" + name + ")") != map.npos
                           : all.find(name + ")") != all.npos || all.find(name + "\"") != all.npos;
    CHECK(found);
  }
}

TEST_CASE("a page begins with an example, and README.md is short") {
  for (const fs::path& page : pages::below({"docs"}, {".md"})) {
    const std::string name = fs::relative(page, folders::source() / "docs").generic_string();
    if (name == "README.md" || name == "theory/glossary.md") continue;  // nobody reads them from the top
    INFO(name);
    std::vector<std::string> lines = pages::lines_of(page);
    lines.resize(12);
    CHECK(std::ranges::any_of(lines, [](const std::string& line) { return line.starts_with("```"); }));
  }
  CHECK(pages::lines_of(folders::source() / "README.md").size() <= 120);
  // Comments name the records of figures: no reader sees them.
  std::istringstream words(std::regex_replace(source_text("README.md"), std::regex("<!--[^>]*-->"), ""));
  CHECK(std::distance(std::istream_iterator<std::string>(words), {}) <= 900);
}

TEST_CASE("commands in the pages name commands, options and files that there are") {
  const std::string cli = cli_sources(), makefile = source_text("Makefile");
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
    std::istringstream text(line.text);
    const std::vector<std::string> words(std::istream_iterator<std::string>(text), {});
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
        CHECK(fs::exists(folders::source() / word.substr(0, word.find(';'))));
        ++files;
      }
  }
  CHECK(drape_commands > 40);
  CHECK(make_targets > 15);
  CHECK(files > 10);
}

TEST_CASE("sources that the pages name are there, with their folders or without") {
  const fs::path root = folders::source();
  std::set<std::string> sources;
  for (const char* folder : {"core", "plugins", "tests", "benchmarks", "examples", "viewer", "configs"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      sources.insert(entry.path().filename().string());
  const std::string path =
      "(?:core|plugins|tests|benchmarks|examples|viewer|configs|third_party)/[a-z0-9_./-]*";
  int named = 0;
  for (const fs::path& page : pages_and_readmes())
    for (const auto& name :
         matches_in(pages::text_of(page), "`(" + path + "|[a-z0-9_]+\\.(?:cpp|h|py|mjs))`")) {
      INFO(page.string() << " names " << name[0]);
      const bool has_folder = name[1].find('/') != std::string::npos;
      CHECK((has_folder ? fs::exists(root / name[1]) : sources.contains(name[1])));
      ++named;
    }
  CHECK(named > 100);
}

TEST_CASE("docs/reference/command.md lists every command") {
  const std::string page = source_text("docs/reference/command.md");
  const auto commands =
      matches_in(cli_sources(), "commands\\s*\\.add(?:_with_plugins)?\\(\\s*\"([a-z0-9-]+)\"");
  for (const auto& command : commands) {
    if (command[1] == "sweep-job") continue;  // hidden: a cluster's jobs run it
    INFO(command[1]);
    CHECK(page.find("\n- `drape " + command[1]) != std::string::npos);
  }
  CHECK(commands.size() > 10);
}
