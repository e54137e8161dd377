#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/metric_declaration.h"
#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

class LevelModel;

/// One value. In results.json, "a.b" is member b of the object a; the column "a" declares it.
struct MetricValue {
  std::string name;
  double value = 0;
};

/// One scalar for each vertex of the level. Those of pairs are written to fields/, for pictures; those of
/// states are for callers of the library.
struct MetricField {
  std::string name;  ///< letters, digits and underscores, other than x, y and z
  Eigen::VectorXd values;
  std::string unit;
};

struct MetricResult {
  std::vector<MetricValue> values;
  std::vector<MetricField> fields;
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
