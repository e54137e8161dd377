#pragma once

#include <vector>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// Cusick's drape test, seen along z: drape_coefficient [%], folds [1] and fold_amplitude [m].
class DrapeCoefficient : public Metric {
 public:
  double support_radius = 0.09;

  static void declare(Declaration<DrapeCoefficient>& d) {
    d.add("support_radius", &DrapeCoefficient::support_radius)
        .unit("m")
        .above(0)
        .at_most(1e3)
        .description("radius of the disc that carries the specimen; 0.09 m in BS 5058 and ISO 9073-9")
        .required();
  }

  MetricDeclaration declaration() const override;

  /// Distance of the shadow's outline from the cloth's centre, in `directions` evenly spaced directions from
  /// x on [m].
  static std::vector<double> outline(const Level& level, const Positions& x, int directions);

 private:
  MetricResult measure(const MetricInput& input) const override;
};

}  // namespace drape
