#pragma once

#include "core/kernel/interfaces/metric.h"

namespace drape {

/// Distances between two states, in units of the rest shape's bounding-box diagonal: distance_rms,
/// distance_max over corresponding vertices, distance_hausdorff between the surfaces.
class Distance : public Metric {
 public:
  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override;

 private:
  MetricResult measure(const MetricInput& input) const override;
};

}  // namespace drape
