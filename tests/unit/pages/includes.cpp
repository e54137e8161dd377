// Includes go one way: a folder's files include its own and those of folders above it in core/README.md.

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/folders.h"
#include "tests/support/pages.h"

namespace fs = std::filesystem;

namespace {

/// The folders of the tables of core/README.md, from the lowest upwards: "core/kernel/files", …
std::vector<std::string> folders_of_core() {
  static const std::regex heading("## (kernel|numerics|app)/.*"), row("\\| `([a-z_]+)/` \\|.*");
  std::vector<std::string> order;
  std::string library;
  std::smatch match;
  for (const std::string& line : pages::lines_of(folders::source() / "core/README.md")) {
    if (std::regex_match(line, match, heading)) library = match[1];
    if (std::regex_match(line, match, row)) order.push_back("core/" + library + "/" + match[1].str());
  }
  return order;
}

std::vector<fs::path> sources_in(const std::string& folder) {
  std::vector<fs::path> files = pages::below({folder}, {".h", ".cpp"});
  for (fs::path& file : files) file = file.lexically_relative(folders::source());
  return files;
}

/// The project's own files that a file includes.
std::vector<std::string> includes_of(const fs::path& file) {
  static const std::regex include("#include \"([^\"]+)\"");
  std::vector<std::string> included;
  std::smatch match;
  for (const std::string& line : pages::lines_of(folders::source() / file))
    if (std::regex_match(line, match, include)) included.push_back(match[1]);
  return included;
}

/// Position of a file's folder in the order; its end for any other folder.
std::size_t rank(const std::vector<std::string>& order, const fs::path& file) {
  return std::find(order.begin(), order.end(), file.parent_path().generic_string()) - order.begin();
}

}  // namespace

TEST_CASE("the tables of core/README.md name every folder of the core") {
  const std::vector<std::string> order = folders_of_core();
  CHECK(order.size() >= 14);
  for (const std::string& folder : order) {
    CAPTURE(folder);
    CHECK(fs::is_directory(folders::source() / folder));
  }
  for (const char* library : {"core/kernel", "core/numerics", "core/app"})
    for (const fs::path& file : sources_in(library)) {
      CAPTURE(file);
      CHECK((rank(order, file) < order.size() || file == "core/kernel/version.h"));
    }
}

TEST_CASE("no include of the core leads to a folder above its own") {
  const std::vector<std::string> order = folders_of_core();
  int counted = 0;
  for (const fs::path& file : sources_in("core"))
    for (const std::string& included : includes_of(file)) {
      if (included == "core/kernel/version.h") continue;
      ++counted;
      CAPTURE(file, included);
      CHECK(rank(order, included) <= rank(order, file));
    }
  CHECK(counted > 500);
}

TEST_CASE("a plugin includes the kernel, the numerics and its own folder, nothing else of the project") {
  for (const fs::path& file : sources_in("plugins")) {
    if (file.filename().string().rfind("test_", 0) == 0) continue;
    for (const std::string& included : includes_of(file)) {
      CAPTURE(file, included);
      CHECK((included.rfind("core/kernel/", 0) == 0 || included.rfind("core/numerics/", 0) == 0 ||
             fs::path(included).parent_path() == file.parent_path()));
    }
  }
}

TEST_CASE(
    "the library's installed headers include Eigen and the standard library, nothing else from outside") {
  static const std::regex outside("#include <([A-Za-z0-9_]+/|[a-z_]+\\.h>).*");
  std::smatch match;
  for (const char* part : {"core/kernel", "core/numerics"})
    for (const fs::path& file : sources_in(part)) {
      if (file.extension() != ".h" || file.filename() == "cholmod_context.h") continue;
      for (const std::string& line : pages::lines_of(folders::source() / file))
        if (std::regex_match(line, match, outside)) {
          CAPTURE(file, line);
          CHECK((match[1] == "Eigen/" || match[1] == "immintrin.h>"));
        }
    }
}

TEST_CASE("the kernel stays small, and no folder of the core has more files than a reader takes in") {
  int lines = 0;
  for (const fs::path& file : sources_in("core/kernel"))
    lines += static_cast<int>(pages::lines_of(folders::source() / file).size());
  CHECK(lines <= 4200);
  for (const std::string& folder : folders_of_core()) {
    if (folder.rfind("core/app/", 0) == 0) continue;
    CAPTURE(folder);
    CHECK(sources_in(folder).size() <= 25);
  }
}
