#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drape {

/// A number of a run, absent if the run did not reach or measure it.
using OptionalNumber = std::optional<double>;

/// A table of a run, with columns by the header's names. An incomplete last line of a killed run is ignored;
/// a missing file is an empty table. Throws std::runtime_error for an incomplete line before the last.
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
