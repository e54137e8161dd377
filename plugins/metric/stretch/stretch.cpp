#include "plugins/metric/stretch/stretch.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/kernel/elements/stretch.h"
#include "core/kernel/plugin/plugin.h"

namespace drape {

MetricResult Stretch::evaluate(const MetricInput& input) const {
  const Positions& x = input.x;
  if (x.rows() != input.level.vertex_count())
    throw std::runtime_error("stretch: the state has " + std::to_string(x.rows()) + " vertices, the level " +
                             std::to_string(input.level.vertex_count()));
  if (!x.allFinite()) throw std::runtime_error("stretch: the state has positions that are not finite");

  double largest = 0, smallest = std::numeric_limits<double>::infinity(), weighted_sum = 0, area_sum = 0;
  Eigen::VectorXd vertex_stretch = Eigen::VectorXd::Zero(x.rows());
  for (int t = 0; t < input.level.triangle_count(); ++t) {
    const auto corner = input.level.rest.triangles.row(t);
    const RestTriangle triangle = RestTriangle::of(input.level, t);
    const PrincipalStretch<double> s =
        triangle.stretch(x.row(corner[1]) - x.row(corner[0]), x.row(corner[2]) - x.row(corner[0]));
    largest = std::max(largest, s.largest);
    smallest = std::min(smallest, s.smallest);
    weighted_sum += triangle.area * s.largest;
    area_sum += triangle.area;
    for (const int i : corner) vertex_stretch[i] = std::max(vertex_stretch[i], s.largest);
  }

  MetricResult result;
  result.values = {{"largest_stretch", largest, "1", Better::neither},
                   {"smallest_stretch", smallest, "1", Better::neither},
                   {"mean_stretch", weighted_sum / area_sum, "1", Better::neither}};
  result.fields = {{"stretch", vertex_stretch, "1"}};
  return result;
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Stretch>("stretch", "Principal stretches of a state's triangles.");
}
