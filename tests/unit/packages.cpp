// Which Debian packages are installed for what: the two lists of third_party, and who reads them.

#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/pages.h"

namespace fs = std::filesystem;

namespace {

std::string project_text(const char* name) { return pages::text_of(fs::path(folders::source()) / name); }

std::vector<std::string> packages_of(const char* list) {
  std::vector<std::string> packages;
  for (const std::string& line : pages::lines_of(fs::path(folders::source()) / "third_party" / list))
    if (!line.empty() && line[0] != '#') packages.push_back(line);
  return packages;
}

/// All that a pattern's group finds in a text.
std::vector<std::string> found(const std::string& text, const char* pattern) {
  std::vector<std::string> all;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    all.push_back((*it)[1].str());
  return all;
}

}  // namespace

TEST_CASE("each package is in one of the lists, once") {
  const auto to_run = packages_of("packages-to-run.txt"), to_test = packages_of("packages-to-test.txt"),
             to_use_python = packages_of("packages-to-use-python.txt");
  CHECK(to_run.size() > 10);
  CHECK(to_test.size() > 5);
  std::set<std::string> all;
  for (const auto* list : {&to_run, &to_test, &to_use_python})
    for (const std::string& package : *list) {
      INFO(package);
      CHECK(std::regex_match(package, std::regex("[a-z0-9][a-z0-9.+-]+")));
      CHECK(all.insert(package).second);
    }
  // What makes `make demo` short: it installs no browser and no analysers.
  for (const std::string& package : to_run)
    CHECK_FALSE(std::regex_search(package, std::regex("chrom|node|clang|npm")));
}

TEST_CASE("Makefile, Dockerfile and CI install packages by the lists alone") {
  for (const char* name : {"Makefile", "Dockerfile"}) {
    INFO(name);
    const std::vector<std::string> installed =
        found(project_text(name), "third_party/setup((?: (?:run|test|use-python))+)[ \n]");
    CHECK_FALSE(installed.empty());
    for (const std::string& lists : installed) {
      std::istringstream words(lists);
      for (std::string list; words >> list;)
        CHECK(fs::exists(fs::path(folders::source()) / "third_party" / ("packages-to-" + list + ".txt")));
    }
    if (std::string(name) == "Makefile")
      CHECK(found(project_text(name), "(third_party/setup)").size() == installed.size());
  }
  CHECK_FALSE(found(project_text(".ci/run"), "(make setup)").empty());
  CHECK(found(project_text("Makefile"), "(apt-get install)").empty());
  CHECK(found(project_text(".ci/run"), "(apt-get)").empty());
}

TEST_CASE("the Dockerfile is of Debian 12, and its commands are the README's") {
  const std::string text = project_text("Dockerfile"), makefile = project_text("Makefile"),
                    readme = project_text("README.md");
  CHECK(found(text, "\nFROM ([^\n]+)\n") == std::vector<std::string>{"debian:12"});
  // What the first command needs; everything else is in the lists.
  CHECK(found(text, "apt-get install -y --no-install-recommends ([^&]*) &&") ==
        std::vector<std::string>{"ca-certificates git make"});
  CHECK(text.find("third_party/setup run") != text.npos);
  CHECK(text.find("CMD [\"make\", \"demo\"]") != text.npos);
  int copied = 0;
  for (const std::string& line : pages::lines_of(fs::path(folders::source()) / "Dockerfile")) {
    if (!line.starts_with("COPY ")) continue;
    std::istringstream words(line.substr(5));
    for (std::string word; words >> word; ++copied)
      if (word != "." && !word.ends_with("/")) CHECK(fs::exists(fs::path(folders::source()) / word));
  }
  CHECK(copied >= 4);
  for (const char* command : {"make demo", "make test"}) {
    CHECK(text.find(command) != text.npos);
    CHECK(readme.find(command) != readme.npos);
  }
  for (const std::string& target : found(text, "make ([a-z]+)\n"))
    CHECK(makefile.find("\n" + target + ":") != makefile.npos);
}
