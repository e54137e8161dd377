#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/report/run_data.h"

namespace drape {

/// A table that a run has written; columns are found by the header's names. A last line cut short by a killed
/// run is left out; a file that is not there is an empty table.
class Csv {
 public:
  explicit Csv(const std::filesystem::path& path);

  std::size_t size() const { return rows_.size(); }
  bool has(const std::string& column) const { return columns_.count(column) > 0; }
  /// Empty, or absent, where there is no such column.
  std::string text(std::size_t row, const std::string& column) const;
  OptionalNumber number(std::size_t row, const std::string& column) const;

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// The number that a text begins with, if it is finite.
OptionalNumber number_of(const std::string& cell);

}  // namespace drape
