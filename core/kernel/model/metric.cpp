#include "core/kernel/model/metric.h"

#include <stdexcept>

namespace drape {

MetricResult Metric::evaluate(const MetricInput& input) const {
  const int vertices = input.level.vertex_count();
  const auto count = [](const Positions& x) { return std::to_string(x.rows()); };
  if (scope() == MetricScope::pair) {
    if (!input.other)
      throw std::runtime_error("this metric compares two states of one level, but was given one");
    if (input.x.rows() != vertices || input.other->rows() != vertices)
      throw std::runtime_error("both states must have the level's " + std::to_string(vertices) +
                               " vertices, not " + count(input.x) + " and " + count(*input.other));
    if (!input.other->allFinite()) throw std::runtime_error("a state has positions that are not finite");
  } else if (input.x.rows() != vertices) {
    throw std::runtime_error("the state has " + count(input.x) + " vertices, the level " +
                             std::to_string(vertices));
  }
  if (!input.x.allFinite()) throw std::runtime_error("a state has positions that are not finite");
  return measure(input);
}

}  // namespace drape
