#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/app/files/optional_number.h"

namespace drape {

/// A table of a run, with columns by the header's names. An incomplete last line of a killed run is ignored;
/// a missing file is an empty table. Throws std::runtime_error for an incomplete line before the last.
class Csv {
 public:
  Csv() = default;
  explicit Csv(const std::filesystem::path& path);

  std::size_t size() const { return rows_.size(); }
  /// In the file's order.
  const std::vector<std::string>& names() const { return names_; }
  bool has(const std::string& column) const { return columns_.count(column) > 0; }
  /// Empty or absent without such a column.
  std::string text(std::size_t row, const std::string& column) const;
  OptionalNumber number(std::size_t row, const std::string& column) const;

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// The finite number that the whole text spells, in any locale.
OptionalNumber number_of(const std::string& cell);

}  // namespace drape
