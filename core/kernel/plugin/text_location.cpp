#include "core/kernel/plugin/text_location.h"

#include <algorithm>
#include <string>

#include "core/kernel/files/file.h"

namespace drape {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The byte of the file at which a line and column begin; npos without them.
std::size_t offset_of(const std::string& file, const Location& where) {
  std::size_t line = 0;
  for (int i = 1; i < where.line; ++i) {
    line = file.find('\n', line);
    if (line == std::string::npos) return line;
    ++line;
  }
  return std::min(line + static_cast<std::size_t>(where.column - 1), file.size());
}

/// The byte of the file that is byte `at` of the text, which begins behind `begin`. Line breaks and
/// indentation may differ between the two. npos if they do not agree.
std::size_t matching(const std::string& file, std::size_t begin, const std::string& text, std::size_t at) {
  std::size_t i = begin;
  if (i < file.size() && (file[i] == '"' || file[i] == '\'')) ++i;
  if (i < file.size() && (file[i] == '|' || file[i] == '>')) i = std::min(file.find('\n', i), file.size());
  for (std::size_t j = 0;; ++j, ++i) {
    while (j < text.size() && is_space(text[j]) && j < at) ++j;
    while (i < file.size() && is_space(file[i]) && j < text.size()) ++i;
    if (j == at) return i;
    if (j == text.size() || i == file.size() || text[j] != file[i]) return std::string::npos;
  }
}

}  // namespace

Location location_in_text(const ConfigNode& scalar, std::size_t at) {
  Location where = scalar.where;
  if (scalar.kind != ConfigNode::Kind::scalar || where.line <= 0 || where.column <= 0) return where;
  std::string file;
  try {
    file = read_file(where.file);
  } catch (const std::exception&) {
    return where;
  }
  const std::size_t begin = offset_of(file, where);
  if (begin == std::string::npos) return where;
  const std::size_t found = matching(file, begin, scalar.scalar, std::min(at, scalar.scalar.size()));
  if (found == std::string::npos) return where;
  const auto end = file.begin() + static_cast<std::ptrdiff_t>(found);
  where.line = static_cast<int>(std::count(file.begin(), end, '\n')) + 1;
  const std::size_t line = found == 0 ? 0 : file.rfind('\n', found - 1) + 1;  // npos + 1 is 0
  where.column = static_cast<int>(found - line) + 1;
  return where;
}

}  // namespace drape
