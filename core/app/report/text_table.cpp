#include "core/app/report/text_table.h"

#include <algorithm>

namespace drape {

namespace {

/// Width on a terminal: UTF-8 continuation bytes count zero.
std::size_t columns_of(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0) != 0x80; });
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], columns_of(row[k]));
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k)
      text += (k > 0 ? "  " : "") + row[k] +
              (k + 1 < row.size() ? std::string(widths[k] - columns_of(row[k]), ' ') : "");
    text += "\n";
  }
  return text;
}

}  // namespace drape
