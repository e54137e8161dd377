#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/folders.h"

/// The project's Markdown pages, for the tests that read them.
namespace pages {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The files with these extensions below these folders of the sources, in order.
inline std::vector<std::filesystem::path> below(const std::vector<std::string>& folders,
                                                const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> found;
  for (const std::string& folder : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folders::source() / folder))
      if (std::ranges::find(extensions, entry.path().extension().string()) != extensions.end())
        found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// README.md, CONTRIBUTING.md and every page in docs/.
inline std::vector<std::filesystem::path> documents() {
  std::vector<std::filesystem::path> found = below({"docs"}, {".md"});
  for (const char* page : {"README.md", "CONTRIBUTING.md"}) found.push_back(folders::source() / page);
  return found;
}

}  // namespace pages
