#pragma once

#include <regex>
#include <string>
#include <vector>

#include "tests/support/pages.h"

/// Every match of a pattern in a text: the whole, and its groups.
inline std::vector<std::vector<std::string>> matches_in(const std::string& text, const std::string& pattern) {
  std::vector<std::vector<std::string>> all;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    all.emplace_back(it->begin(), it->end());
  return all;
}

/// The texts of these files, one after the other.
inline std::string texts_of_files(const std::vector<std::filesystem::path>& files) {
  std::string all;
  for (const std::filesystem::path& file : files) all += pages::text_of(file);
  return all;
}

/// The text of a file of the sources.
inline std::string source_text(const std::string& file) { return pages::text_of(folders::source() / file); }
