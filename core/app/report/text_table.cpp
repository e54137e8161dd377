#include "core/app/report/text_table.h"

#include <algorithm>

#include "core/kernel/files/string_utils.h"

namespace drape {

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], display_width(row[k]));
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k)
      text += (k > 0 ? "  " : "") + (k + 1 < row.size() ? padded(row[k], widths[k]) : row[k]);
    text += "\n";
  }
  return text;
}

}  // namespace drape
