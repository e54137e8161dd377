// Includes go one way: a folder's files include its own and those of folders above it in core/README.md. What
// the built libraries need and export, as the dynamic linker sees it.

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "tests/support/command.h"
#include "tests/unit/pages/source_texts.h"

namespace fs = std::filesystem;

namespace {

/// The folders of the tables of core/README.md, from the lowest upwards: "core/kernel/files", …
std::vector<std::string> folders_of_core() {
  std::vector<std::string> order;
  std::string library;
  const std::string heading = "\n## (kernel|numerics|app)/", row = "\n\\| `([a-z_]+)/` \\|";
  for (const auto& match : matches_in(source_text("core/README.md"), heading + "|" + row)) {
    if (!match[1].empty()) library = match[1];
    if (!match[2].empty()) order.push_back("core/" + library + "/" + match[2]);
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
  std::vector<std::string> included;
  for (const auto& match : matches_in(source_text(file), "(^|\n)#include \"([^\"]+)\""))
    included.push_back(match[2]);
  return included;
}

/// Position of a file's folder in the order; its end for any other folder.
std::size_t rank(const std::vector<std::string>& order, const fs::path& file) {
  return std::find(order.begin(), order.end(), file.parent_path().generic_string()) - order.begin();
}

/// Adds the types that a source defines in namespaces with a name. The layout of .clang-format is relied
/// upon: whatever a namespace holds begins its line, and namespaces end with a comment.
void add_types(const fs::path& file, std::map<std::string, std::vector<fs::path>>& files_of) {
  static const std::regex opened("namespace ?([a-z_:]*) ?\\{"), closed("\\}  // namespace.*"),
      type("(?:struct|class|union|enum|enum class) (\\w+)(?: final)?(?: ?:[^:].*)? ?\\{.*");
  std::vector<std::string> namespaces;
  std::smatch match;
  for (const std::string& line : pages::lines_of(folders::source() / file)) {
    if (std::regex_match(line, match, opened)) namespaces.push_back(match[1]);
    if (std::regex_match(line, closed) && !namespaces.empty()) namespaces.pop_back();
    if (!std::regex_match(line, match, type)) continue;
    std::string name;
    bool local = namespaces.empty();
    for (const std::string& part : namespaces) name += part + "::", local = local || part.empty();
    if (!local) files_of[name + match[1].str()].push_back(file);
  }
}

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
  for (const std::string& line : lines_by("readelf -d -W '" + library.string() + "'"))
    for (const auto& match : matches_in(line, "\\(NEEDED\\).*\\[(.*\\.so)")) needed.insert(match[1]);
  return needed;
}

/// Names of the symbols that a library defines for others (`nm --defined-only`) or takes from others.
std::vector<std::string> symbols_of(const fs::path& library, const std::string& which) {
  return lines_by("nm -D -j " + which + " '" + library.string() + "'");
}

fs::path library(const std::string& name) { return folders::commands().parent_path() / "lib" / name; }

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

TEST_CASE("no include of the core leads to a later folder of the tables") {
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
    if (file.filename().string().starts_with("test_")) continue;
    for (const std::string& included : includes_of(file)) {
      CAPTURE(file, included);
      CHECK((included.starts_with("core/kernel/") || included.starts_with("core/numerics/") ||
             fs::path(included).parent_path() == file.parent_path()));
    }
  }
}

TEST_CASE("the library's installed headers include nothing but Eigen and the standard library from outside") {
  for (const char* part : {"core/kernel", "core/numerics"})
    for (const fs::path& file : sources_in(part)) {
      if (file.extension() != ".h" || file.filename() == "cholmod_context.h") continue;
      for (const auto& match :
           matches_in(source_text(file), "(^|\n)#include <([A-Za-z0-9_]+/|[a-z_]+\\.h>)")) {
        CAPTURE(file, match[0]);
        CHECK((match[2] == "Eigen/" || match[2] == "immintrin.h>"));
      }
    }
}

TEST_CASE("the kernel stays small, and no folder of the core has more files than a reader takes in") {
  std::size_t lines = 0;
  for (const fs::path& file : sources_in("core/kernel"))
    lines += pages::lines_of(folders::source() / file).size();
  CHECK(lines <= 4200);
  for (const std::string& folder : folders_of_core()) {
    CAPTURE(folder);
    if (!folder.starts_with("core/app/")) CHECK(sources_in(folder).size() <= 25);
  }
}

TEST_CASE("a name stands for one type in the library and the plugins together") {
  // They are one program: of an inline function or a template that several define for a type, one is used by
  // all.
  std::map<std::string, std::vector<fs::path>> files_of;
  for (const char* folder : {"core", "plugins"})
    for (const fs::path& file : sources_in(folder)) add_types(file, files_of);
  CHECK(files_of.count("drape::TriangleMesh") == 1);
  CHECK(files_of.size() > 300);
  for (const auto& [name, files] : files_of) {
    CAPTURE(name, files);
    CHECK(files.size() == 1);
  }
}

TEST_CASE("libdrape needs no YAML, picture, socket or JSON") {
  const std::set<std::string> needed = needed_by(library("libdrape.so"));
  CHECK(needed.count("libcholmod.so") == 1);
  for (const char* absent : {"libyaml-cpp.so", "libembree3.so", "libpng16.so", "libcpp-httplib.so",
                             "libssl.so", "libz.so", "libdrape_app.so"}) {
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
    // Headers of other libraries make some of theirs visible.
    std::vector<std::string> own = symbols_of(entry.path(), "--defined-only");
    std::erase_if(own, [](const std::string& name) { return name.find("drape") == name.npos; });
    CHECK(own == std::vector<std::string>{"drape_plugin"});
  }
  CHECK(plugins > 20);
}
