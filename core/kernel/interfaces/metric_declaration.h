#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace drape {

enum class Better { lower, higher, neither };

/// Where reports show a value.
enum class Shown {
  stored,  ///< only in results.json
  tables,  ///< in tables of levels or of pairs of levels too
  summary  ///< also in tables with one row per method
};

/// Where reports show a pair's value as the error of a state (docs/theory/errors.md).
enum class ErrorUse {
  plots,    ///< only in plots of error against cost
  summary,  ///< in tables with one row per method too
  ranking   ///< summaries also rank methods by it
};

/// Declares a value of a metric.
struct MetricColumn {
  std::string name = {};   ///< of the value
  std::string label = {};  ///< for a reader: "d_H^fit" has a subscript and a superscript
  std::string unit = {};   ///< "1" if dimensionless
  Better better = Better::lower;
  Shown shown = Shown::tables;
  int decimals = -1;       ///< shown after the point; -1 for three significant digits
  std::string best = {};   ///< what the best method does: "changes its curvature least"; may be empty
  std::string error = {};  ///< name of the value as an error, in errors.csv; empty if it is none
  ErrorUse error_use = ErrorUse::plots;  ///< where higher is better the error is 1 − value
};

/// What the 3D view of a page shows of a field.
enum class PictureKind {
  difference,  ///< of each level from the finest
  threshold    ///< of the state of every level
};

/// Longest name of a picture [bytes]: the paths of its files are checked before a run.
inline constexpr std::size_t longest_picture_name = 24;

/// Declares colours of the 3D view for a field of a pair metric.
struct MetricPicture {
  PictureKind kind = PictureKind::difference;
  std::string name = {};         ///< ends the names of its files; at most longest_picture_name
  std::string field = {};        ///< of the difference, or of the fine state
  std::string other_field = {};  ///< of the coarse state; `threshold` only
  std::string unit = {};
  std::string label = {};   ///< "difference in mean curvature"
  std::string title = {};   ///< of its section in a report
  std::string text = {};    ///< what it shows, in a few sentences
  std::string column = {};  ///< value in its caption; may be empty
};

/// How reports show the values and fields of a metric.
struct MetricDeclaration {
  std::vector<MetricColumn> columns = {};    ///< all values, in the order of tables
  std::vector<MetricPicture> pictures = {};  ///< of pair metrics
  std::string text = {};                     ///< what the columns mean, in a few sentences
};

}  // namespace drape
