#pragma once

#include "core/kernel/interfaces/metric.h"

namespace drape {

/// Principal stretches of a state's triangles: largest_stretch, smallest_stretch, mean_stretch [1].
class Stretch : public Metric {
 public:
  MetricDeclaration declaration() const override;

 private:
  /// Throws std::runtime_error if a rest triangle has no area.
  MetricResult measure(const MetricInput& input) const override;
};

}  // namespace drape
