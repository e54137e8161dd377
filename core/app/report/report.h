#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drape {

/// Writes DIR/report.html, one page that needs no other file and no network, and DIR/pictures/*.png from
/// what a finished or interrupted run has left in DIR (results.json, iterations.csv, config.yaml, levels/,
/// fields/, rest/). Missing values show as a dash or a sentence. Pictures are `picture_width` (default: 900)
/// pixels wide, and skipped once `cancelled` (may be empty) returns true. Returns what could not be drawn,
/// one line each. Throws std::runtime_error with one line if DIR has no readable results.json or is not
/// writable.
std::vector<std::string> write_report(const std::filesystem::path& run_directory,
                                      const std::function<bool()>& cancelled = {},
                                      std::optional<int> picture_width = {});

}  // namespace drape
