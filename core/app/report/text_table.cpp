#include "core/app/report/text_table.h"

#include <algorithm>

#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

std::string number_text(const OptionalNumber& value) {
  if (!value) return "–";
  if (*value == 0) return "0";
  const std::string text = scientific_text(*value, 2);
  const std::size_t e = text.find('e');
  const int exponent = std::stoi(text.substr(e + 1));
  if (exponent < -2 || exponent > 3) return text.substr(0, e) + "e" + std::to_string(exponent);
  return fixed_text(parse_number(text).value(), std::max(0, 2 - exponent));
}

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
