#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/mesh/triangle_mesh.h"
#include "core/kernel/model/level.h"

namespace drape {

class LevelModel;

enum class Better { lower, higher, neither };

/// One value, with its unit and the better direction.
struct MetricValue {
  std::string name;
  double value = 0;
  std::string unit;
  Better better = Better::lower;
};

/// One scalar for each vertex of the fine level, for pictures.
struct MetricField {
  std::string name;
  Eigen::VectorXd values;
  std::string unit;
};

struct MetricResult {
  std::vector<MetricValue> values;
  std::vector<MetricField> fields;
};

/// Whether a metric measures one state or a pair.
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

/// A measure of a state or of a pair of states. Evaluation is const and stateless.
class Metric {
 public:
  virtual ~Metric() = default;
  virtual MetricScope scope() const = 0;
  virtual MetricResult evaluate(const MetricInput& input) const = 0;
};

}  // namespace drape
