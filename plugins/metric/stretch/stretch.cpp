#include "core/numerics/elements/stretch.h"

#include <algorithm>
#include <limits>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/vertex_fields.h"

namespace drape {

/// Principal stretches of a state's triangles: largest_stretch, smallest_stretch, mean_stretch [1].
class Stretch : public Metric {
 public:
  MetricDeclaration declaration() const override {
    return {.columns =
                {{.name = "largest_stretch", .unit = "1", .better = Better::neither, .shown = Shown::summary},
                 {.name = "smallest_stretch", .unit = "1", .better = Better::neither, .shown = Shown::stored},
                 {.name = "mean_stretch", .unit = "1", .better = Better::neither, .shown = Shown::stored}},
            .text = "Stretch is the largest principal stretch (1 is unstretched)."};
  }

 private:
  /// Throws std::runtime_error if a rest triangle has no area.
  MetricResult measure(const MetricInput& input) const override {
    const Positions& x = input.x;
    double largest = 0, smallest = std::numeric_limits<double>::infinity(), weighted_sum = 0, area_sum = 0;
    for (int t = 0; t < input.level.triangle_count(); ++t) {
      const auto corner = input.level.rest.triangles.row(t);
      const RestTriangle triangle = RestTriangle::of(input.level, t);
      const PrincipalStretch<double> s =
          triangle.stretch(x.row(corner[1]) - x.row(corner[0]), x.row(corner[2]) - x.row(corner[0]));
      largest = std::max(largest, s.largest);
      smallest = std::min(smallest, s.smallest);
      weighted_sum += triangle.area * s.largest;
      area_sum += triangle.area;
    }
    return {{{"largest_stretch", largest},
             {"smallest_stretch", smallest},
             {"mean_stretch", weighted_sum / area_sum}},
            {{"stretch", largest_stretch(input.level, x)}}};
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Stretch>("stretch", "Principal stretches of a state's triangles.");
}
