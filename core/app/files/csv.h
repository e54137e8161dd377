#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drape {

struct CsvRow {
  std::vector<std::string> cells;
  std::size_t line = 1;  ///< of the file, where it begins
};

/// The rows of a file of separated values (RFC 4180) with any system's line ends: in double quotes separators
/// and line ends are text, and two quotes are one. Its separator is the first of these that it has. A last
/// line that is cut within quotes is left out if the file `may_be_cut`. Throws std::runtime_error for another
/// quote without its end.
std::vector<CsvRow> csv_rows(const std::filesystem::path& file, std::string_view text,
                             const std::string& separators = ",", bool may_be_cut = false);

/// A number of a run, absent if the run did not reach or measure it.
using OptionalNumber = std::optional<double>;

/// A table of a run, with columns by the header's names. An incomplete last line of a killed run is ignored;
/// a missing file is an empty table. Throws std::runtime_error for any other line whose number of cells is
/// not the header's.
class Csv {
 public:
  Csv() = default;
  explicit Csv(const std::filesystem::path& path);

  std::size_t size() const { return rows_.size(); }
  /// In the file's order.
  const std::vector<std::string>& names() const { return names_; }
  /// Empty or absent without such a column.
  std::string text(std::size_t row, const std::string& column) const;
  OptionalNumber number(std::size_t row, const std::string& column) const;

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace drape
