#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace drape {

enum class Better { lower, higher, neither };

/// Where reports show a value.
enum class Shown {
  stored,  ///< only in results.json, and in `drape table` by name
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
  std::string error = {};  ///< name of the value as an error, in errors.csv; empty if it is none
  ErrorUse error_use = ErrorUse::plots;  ///< where higher is better the error is 1 − value
};

/// Declares colours of the 3D view for a field of a pair metric.
struct MetricColours {
  std::string field = {};  ///< of the fine state; without `other_field`, of its difference from the coarse
  std::string other_field = {};  ///< the same of the coarse state
  std::string unit = {};
  std::string label = {};  ///< "difference in mean curvature"
};

/// How reports show the values and fields of a metric.
struct MetricDeclaration {
  std::vector<MetricColumn> columns = {};   ///< all values, in the order of tables
  std::vector<MetricColours> colours = {};  ///< of pair metrics
  std::string text = {};                    ///< what the columns mean, in a few sentences

  /// Whether a column declares the value: the column "a" declares "a" and "a.b".
  bool declares(const std::string& value) const {
    return std::any_of(columns.begin(), columns.end(), [&](const MetricColumn& c) {
      return value == c.name || value.starts_with(c.name + ".");
    });
  }
};

}  // namespace drape
