#include "core/app/files/csv.h"

#include <algorithm>

#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"

namespace drape {

std::vector<CsvRow> csv_rows(const std::filesystem::path& file, std::string_view text,
                             const std::string& separators, bool may_be_cut) {
  const std::size_t first = text.find_first_of(separators);
  const char separator = first == std::string_view::npos ? separators[0] : text[first];
  std::vector<CsvRow> rows(1, {{""}});
  std::size_t line = 1, quote = 0;  // the line of the quote that is open
  bool begun = false;               // the cell; a quote within it is text
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    std::vector<std::string>& cells = rows.back().cells;
    const bool ends_line = c == '\n' || (c == '\r' && text.substr(i, 2) != "\r\n");
    line += ends_line;
    if (quote > 0 && text.substr(i, 2) == "\"\"") {
      cells.back() += text[i++];
    } else if (c == '"' && (quote > 0 || !begun)) {
      quote = quote > 0 ? 0 : line;
      begun = true;
    } else if (quote == 0 && (c == separator || ends_line)) {
      begun = false;
      if (ends_line)
        rows.push_back({{""}, line});
      else
        cells.emplace_back();
    } else if (quote > 0 || c != '\r') {
      cells.back() += c;
      begun = begun || (c != ' ' && c != '\t');
    }
  }
  const bool is_cut = may_be_cut && quote == line;
  if (quote > 0 && !is_cut)
    refuse_path(file.string() + ":" + std::to_string(quote), "a quote (\") has no end");
  if (is_cut || rows.back().cells == std::vector<std::string>{""})
    rows.pop_back();  // behind the last line's end
  return rows;
}

Csv::Csv(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return;
  std::size_t incomplete = 0;
  const auto refuse = [&](std::size_t line, const std::string& how_many) {
    refuse_path(path.string() + ":" + std::to_string(line),
                how_many + " cells than the header has; run the experiment again");
  };
  for (CsvRow& row : csv_rows(path, read_file(path), ",", true)) {
    if (incomplete > 0) refuse(incomplete, "fewer");
    if (names_.empty())
      names_ = std::move(row.cells);
    else if (row.cells.size() == names_.size())
      rows_.push_back(std::move(row.cells));
    else if (row.cells.size() > names_.size())
      refuse(row.line, "more");
    else
      incomplete = row.line;
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
