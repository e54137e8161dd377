#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/hierarchy/level.h"
#include "core/mesh/triangle_mesh.h"

namespace drape {

class LevelModel;

enum class Better { lower, higher, neither };

/// One figure, with its unit and which way is better.
struct MetricValue {
  std::string name;
  double value = 0;
  std::string unit;
  Better better = Better::lower;
};

/// One scalar a vertex of the fine level, for pictures.
struct MetricField {
  std::string name;
  Eigen::VectorXd values;
  std::string unit;
};

struct MetricResult {
  std::vector<MetricValue> values;
  std::vector<MetricField> fields;
};

/// Whether a metric looks at one state or at two.
enum class MetricScope {
  state,  ///< one level's state
  pair    ///< a coarse state, carried up to the fine level by its method's interpolation, against a fine one
};

/// What a metric may look at: a state on one level and, for pairs, another on the same level.
struct MetricInput {
  const Level& level;                ///< the (fine) level; area weights are level.vertex_area
  const LevelModel& model;           ///< the plain model of that level
  const Positions& x;                ///< n×3, the state on it; of a pair, the finer one
  const Positions* other = nullptr;  ///< n×3, pairs only: what is measured against x
};

/// A measure of a state or of a pair of states. Evaluation is const and stateless.
class Metric {
 public:
  virtual ~Metric() = default;
  virtual MetricScope scope() const = 0;
  virtual MetricResult evaluate(const MetricInput& input) const = 0;
};

}  // namespace drape
