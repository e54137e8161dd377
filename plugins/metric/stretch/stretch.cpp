#include "plugins/metric/stretch/stretch.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/plugin/plugin.h"
#include "plugins/metric/stretch/principal_stretch.h"

namespace drape {

MetricResult Stretch::evaluate(const MetricInput& input) const {
  const Positions& rest = input.level.rest.vertices;
  const Positions& x = input.x;
  if (x.rows() != rest.rows())
    throw std::runtime_error("stretch: the state has " + std::to_string(x.rows()) + " vertices, the level " +
                             std::to_string(rest.rows()));
  if (!x.allFinite()) throw std::runtime_error("stretch: the state has positions that are not finite");
  const auto vertex = [](const Positions& p, int i) -> Eigen::Vector3d { return p.row(i).transpose(); };

  double largest = 0, smallest = std::numeric_limits<double>::infinity(), weighted_sum = 0, area_sum = 0;
  Eigen::VectorXd vertex_stretch = Eigen::VectorXd::Zero(x.rows());
  for (int t = 0; t < input.level.triangle_count(); ++t) {
    const auto corner = input.level.rest.triangles.row(t);
    const Eigen::Vector3d rest0 = vertex(rest, corner[0]), rest1 = vertex(rest, corner[1]),
                          rest2 = vertex(rest, corner[2]);
    const double area = 0.5 * (rest1 - rest0).cross(rest2 - rest0).norm();
    if (!(area > 0)) throw std::runtime_error("stretch: rest triangle " + std::to_string(t) + " has no area");
    const PrincipalStretches s = principal_stretches(rest0, rest1, rest2, vertex(x, corner[0]),
                                                     vertex(x, corner[1]), vertex(x, corner[2]));
    largest = std::max(largest, s.largest);
    smallest = std::min(smallest, s.smallest);
    weighted_sum += area * s.largest;
    area_sum += area;
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
