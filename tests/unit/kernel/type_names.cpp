#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "tests/support/folders.h"

namespace fs = std::filesystem;

namespace {

/// Adds the types that a source defines in namespaces with a name. The layout of .clang-format is relied
/// upon: whatever a namespace holds begins its line, and namespaces end with a comment.
void add_types(const fs::path& file, std::map<std::string, std::vector<std::string>>& files_of) {
  static const std::regex opened("namespace ?([a-z_:]*) ?\\{"), closed("\\}  // namespace.*"),
      type("(?:struct|class|union|enum|enum class) (\\w+)(?: final)?(?: ?:[^:].*)? ?\\{.*");
  std::ifstream in(file);
  std::vector<std::string> namespaces;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, match, opened)) namespaces.push_back(match[1]);
    if (std::regex_match(line, closed) && !namespaces.empty()) namespaces.pop_back();
    if (!std::regex_match(line, match, type)) continue;
    std::string name;
    bool local = namespaces.empty();
    for (const std::string& part : namespaces) name += part + "::", local = local || part.empty();
    if (!local) files_of[name + match[1].str()].push_back(file.string());
  }
}

}  // namespace

TEST_CASE("a name stands for one type in the library and the plugins together") {
  // They are one program: of an inline function or a template that several define for a type, one is used by
  // all.
  std::map<std::string, std::vector<std::string>> files_of;
  for (const char* folder : {"core", "plugins"})
    for (const auto& entry : fs::recursive_directory_iterator(folders::source() / folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h")
        add_types(entry.path(), files_of);
  CHECK(files_of.count("drape::TriangleMesh") == 1);
  CHECK(files_of.size() > 300);
  for (const auto& [name, files] : files_of) {
    CAPTURE(name, files);
    CHECK(files.size() == 1);
  }
}
