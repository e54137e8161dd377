#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

class LevelModel;

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
  std::string name = {};  ///< of the value
  /// For a reader: "d_H^fit" has a subscript and a superscript. By default the name, with spaces.
  std::string label = {};
  std::string unit = {};  ///< "1" if dimensionless
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

/// One value. In results.json, "a.b" is member b of the object a; the column "a" declares it.
struct MetricValue {
  std::string name;
  double value = 0;
};

struct MetricResult {
  std::vector<MetricValue> values;
  /// Fields over the level's vertices, with names of letters, digits and underscores. Those of pairs are
  /// written to fields/, for pictures; those of states are for callers of the library.
  VertexFields fields;
};

/// What a metric measures.
enum class MetricScope {
  state,  ///< the state of one level
  pair    ///< a coarse state, prolonged to the fine level by its method, against a fine state
};

/// Input of a metric: a state on one level and, for pairs, another on the same level.
struct MetricInput {
  const Level& level;                ///< the (fine) level; area weights are level.vertex_area
  const LevelModel& model;           ///< the plain model of that level
  const Positions& x;                ///< n×3 [m], the state; of a pair, the fine one
  const Positions* other = nullptr;  ///< n×3 [m], pairs only: the prolonged coarse state
};

/// A measure of a state or of a pair of states. Evaluation is const: the same states have the same values.
class Metric {
 public:
  static constexpr const char* kind = "metric";  ///< in the registry
  virtual ~Metric() = default;
  virtual MetricScope scope() const { return MetricScope::state; }
  /// How reports show the values and fields.
  virtual MetricDeclaration declaration() const = 0;
  /// Checks the states, measures them and checks the result. Throws std::runtime_error if a pair's second
  /// state is missing, if a state has another number of vertices than the level or is not finite, or if a
  /// value is not declared, two values have one name, or a field has another length than the level.
  MetricResult evaluate(const MetricInput& input) const;

 private:
  /// The states have been checked.
  virtual MetricResult measure(const MetricInput& input) const = 0;
};

}  // namespace drape
