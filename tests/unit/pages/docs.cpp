// The pages of docs/ and beside the sources: links, pictures, messages and codes that they speak of.

#include <catch2/catch.hpp>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "core/app/experiment/exit_codes.h"
#include "tests/support/pages.h"

namespace fs = std::filesystem;

namespace {

/// All sources of core and plugins, with string literals that go on in the next line joined.
std::string sources() {
  std::string all;
  for (const fs::path& file : pages::below({"core", "plugins"}, {".cpp", ".h"})) all += pages::text_of(file);
  return std::regex_replace(all, std::regex("\"\\s*\n\\s*\""), "");
}

/// Every page with links: documents, and the pages of core, plugins, dependencies and stored results.
std::vector<fs::path> linked_pages() {
  std::vector<fs::path> found = pages::documents();
  for (const fs::path& page : pages::below({"core", "plugins", "third_party", "benchmarks"}, {".md"}))
    found.push_back(page);
  return found;
}

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

}  // namespace

TEST_CASE("docs/guide/troubleshooting.md speaks of messages that there are") {
  const std::string page = pages::text_of(folders::source() / "docs/guide/troubleshooting.md");
  const std::string code = sources();
  const std::regex row("\n\\| `([^`]+)` \\|");
  int rows = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), row), end; it != end; ++it, ++rows) {
    INFO((*it)[1].str());
    CHECK(code.find((*it)[1].str()) != std::string::npos);
  }
  CHECK(rows > 20);
}

TEST_CASE("docs/reference/exit-codes.md has every code as `drape --help` does") {
  const std::string page = pages::text_of(folders::source() / "docs/reference/exit-codes.md");
  for (const drape::ExitCode& code : drape::exit_codes) {
    INFO(code.code);
    CHECK(page.find("\n| `" + std::to_string(code.code) + "` | " + code.description + " |\n") !=
          std::string::npos);
  }
}

TEST_CASE("every link between the pages leads somewhere") {
  const std::regex link("\\]\\(([^)#]*)(#([^)]*))?\\)");
  int links = 0, fragments = 0;
  for (const fs::path& page : linked_pages()) {
    const std::string text = pages::text_of(page);
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string target = (*it)[1], fragment = (*it)[3];
      if (target.starts_with("http")) continue;
      const fs::path file = target.empty() ? page : page.parent_path() / target;
      INFO(page.string() << " links to " << (*it)[0].str());
      CHECK(fs::exists(file));
      ++links;
      if (fragment.empty() || file.extension() != ".md" || !fs::exists(file)) continue;
      CHECK(fragments_of(file).count(fragment) == 1);
      ++fragments;
    }
  }
  CHECK(links > 200);
  CHECK(fragments > 10);
}

TEST_CASE("pages that sources and scripts name are there, with the sections that they name") {
  const fs::path root = folders::source();
  const std::regex name("(docs/[A-Za-z0-9/_-]+\\.md)(,? sections? ([0-9]))?");
  int names = 0, sections = 0;
  std::vector<fs::path> files = {root / "Makefile"};
  for (const char* folder : {"core", "plugins", "tests", "benchmarks", "configs", "third_party"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && entry.file_size() < 200000) files.push_back(entry.path());
  for (const fs::path& file : files) {
    const std::string text = pages::text_of(file);
    for (std::sregex_iterator it(text.begin(), text.end(), name), end; it != end; ++it) {
      INFO(file.string() << " names " << (*it)[0].str());
      const fs::path page = root / (*it)[1].str();
      REQUIRE(fs::exists(page));
      ++names;
      if (!(*it)[3].matched) continue;
      CHECK(pages::text_of(page).find("\n## " + (*it)[3].str() + ". ") != std::string::npos);
      ++sections;
    }
  }
  CHECK(names > 40);
  CHECK(sections > 10);
}

TEST_CASE("docs/README.md is the map of every page, and a page shows every picture") {
  const fs::path docs = folders::source() / "docs";
  const std::string map = pages::text_of(docs / "README.md");
  std::string all;
  for (const fs::path& page : pages::documents()) all += pages::text_of(page);
  for (const fs::path& file : pages::below({"docs"}, {".md", ".png", ".webp"})) {
    const std::string name = fs::relative(file, docs).generic_string();
    INFO(name);
    if (name == "README.md") continue;
    const bool found = file.extension() == ".md" ? map.find("](" + name + ")") != map.npos
                                                 : all.find(name + ")") != all.npos;
    CHECK(found);
  }
}

TEST_CASE("a page begins with an example, and README.md is short") {
  const fs::path root = folders::source();
  for (const fs::path& page : pages::below({"docs"}, {".md"})) {
    const std::string name = fs::relative(page, root / "docs").generic_string();
    // The maps and the glossary are none to read from the top.
    if (name == "README.md" || name == "theory/glossary.md") continue;
    INFO(name);
    const std::vector<std::string> lines = pages::lines_of(page);
    bool example = false;
    for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 12); ++i)
      example = example || lines[i].starts_with("```");
    CHECK(example);
  }
  CHECK(pages::lines_of(root / "README.md").size() <= 120);
  std::istringstream words(pages::text_of(root / "README.md"));
  CHECK(std::distance(std::istream_iterator<std::string>(words), {}) <= 900);
}
