#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "core/app/experiment/exit_codes.h"
#include "tests/support/folders.h"

namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All sources of core and plugins, with string literals that go on in the next line joined.
std::string sources() {
  std::string all;
  for (const char* folder : {"core", "plugins"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(folders::source()) / folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h")
        all += text_of(entry.path());
  return std::regex_replace(all, std::regex("\"\\s*\n\\s*\""), "");
}

}  // namespace

TEST_CASE("docs/guide/troubleshooting.md speaks of messages that there are") {
  const std::string page = text_of(fs::path(folders::source()) / "docs/guide/troubleshooting.md"),
                    code = sources();
  const std::regex row("\n\\| `([^`]+)` \\|");
  int rows = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), row), end; it != end; ++it, ++rows) {
    INFO((*it)[1].str());
    CHECK(code.find((*it)[1].str()) != std::string::npos);
  }
  CHECK(rows > 20);
}

TEST_CASE("docs/reference/exit-codes.md has every code as `drape --help` does") {
  const std::string page = text_of(fs::path(folders::source()) / "docs/reference/exit-codes.md");
  for (const drape::ExitCode& code : drape::exit_codes) {
    INFO(code.code);
    CHECK(page.find("\n| `" + std::to_string(code.code) + "` | " + code.description + " |\n") !=
          std::string::npos);
  }
}

TEST_CASE("Every link between the documents leads somewhere") {
  const fs::path root = folders::source();
  std::vector<fs::path> pages = {root / "README.md", root / "core/README.md", root / "third_party/README.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  const std::regex link("\\]\\(([^)#]+)");
  int links = 0;
  for (const fs::path& page : pages) {
    const std::string text = text_of(page);
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string target = (*it)[1];
      if (target.starts_with("http")) continue;
      INFO(page.string() << " links to " << target);
      CHECK(fs::exists(page.parent_path() / target));
      ++links;
    }
  }
  CHECK(links > 10);
}
