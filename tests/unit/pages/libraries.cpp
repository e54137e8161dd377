// What the built libraries need and export, as the dynamic linker sees it.

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/folders.h"

namespace fs = std::filesystem;

namespace {

/// The lines that a command prints.
std::vector<std::string> lines_by(const std::string& command) {
  const Ended ended = Command(command, folders::commands()).wait();
  INFO(command << ": " << ended.err);
  REQUIRE(ended.exit_code == 0);
  std::istringstream text(ended.out);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

/// The libraries that a library names as needed, without version and path: "libdrape.so".
std::set<std::string> needed_by(const fs::path& library) {
  std::set<std::string> needed;
  for (const std::string& line : lines_by("readelf -d -W '" + library.string() + "'")) {
    if (line.find("(NEEDED)") == std::string::npos) continue;
    const std::size_t open = line.find('[') + 1, end = line.find(".so", open);
    needed.insert(line.substr(open, end - open) + ".so");
  }
  return needed;
}

/// Names of the symbols that a library defines for others (`nm --defined-only`) or takes from others.
std::vector<std::string> symbols_of(const fs::path& library, const std::string& which) {
  return lines_by("nm -D -j " + which + " '" + library.string() + "'");
}

/// Symbols of the project that a library defines for others; headers of other libraries make some of theirs
/// visible.
std::vector<std::string> own_symbols_of(const fs::path& library) {
  std::vector<std::string> names = symbols_of(library, "--defined-only");
  std::erase_if(names, [](const std::string& name) { return name.find("drape") == std::string::npos; });
  return names;
}

fs::path library(const std::string& name) { return folders::commands().parent_path() / "lib" / name; }

}  // namespace

TEST_CASE("libdrape needs no YAML, picture, socket or JSON") {
  const std::set<std::string> needed = needed_by(library("libdrape.so"));
  CHECK(needed.count("libcholmod.so") == 1);
  for (const char* absent : {"libyaml-cpp.so", "libembree3.so", "libpng16.so", "libcpp-httplib.so",
                             "libssl.so", "libdrape_app.so"}) {
    CAPTURE(absent);
    CHECK(needed.count(absent) == 0);
  }
  for (const char* which : {"--defined-only", "--undefined-only"})
    for (const std::string& symbol : symbols_of(library("libdrape.so"), which)) {
      CAPTURE(symbol);
      CHECK(symbol.find("nlohmann") == std::string::npos);
      CHECK(symbol.find("YAML") == std::string::npos);
    }
  CHECK(needed_by(library("libdrape_app.so")).count("libyaml-cpp.so") == 1);
}

TEST_CASE("a plugin needs the kernel, not the application, and exports one function") {
  int plugins = 0;
  for (const auto& entry : fs::directory_iterator(folders::plugins())) {
    if (entry.path().extension() != ".so") continue;
    ++plugins;
    CAPTURE(entry.path());
    const std::set<std::string> needed = needed_by(entry.path());
    CHECK(needed.count("libdrape.so") == 1);
    CHECK(needed.count("libdrape_app.so") == 0);
    CHECK(own_symbols_of(entry.path()) == std::vector<std::string>{"drape_plugin"});
  }
  CHECK(plugins > 20);
}
