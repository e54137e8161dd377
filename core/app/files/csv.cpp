#include "core/app/files/csv.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

Csv::Csv(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return;
  std::istringstream lines(read_file(path));
  std::size_t number = 0, cut_short = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (cut_short > 0)
      throw std::runtime_error(path.string() + ":" + std::to_string(cut_short) +
                               ": fewer cells than the header has; run the experiment again");
    std::vector<std::string> cells = split(line, ',');
    if (!cells.empty() && !cells.back().empty() && cells.back().back() == '\r') cells.back().pop_back();
    if (names_.empty()) {
      names_ = std::move(cells);
    } else if (cells.size() >= names_.size()) {
      rows_.push_back(std::move(cells));
    } else {
      cut_short = number;
    }
  }
}

std::string Csv::text(std::size_t row, const std::string& column) const {
  const auto found = std::find(names_.begin(), names_.end(), column);
  return found == names_.end() ? "" : rows_[row][found - names_.begin()];
}

OptionalNumber Csv::number(std::size_t row, const std::string& column) const {
  return number_of(text(row, column));
}

}  // namespace drape
