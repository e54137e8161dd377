#include "core/app/dressing/sinking.h"

#include <algorithm>

#include "core/numerics/collision_detection/components.h"

namespace drape {

double sinking(const Level& level, const Positions& loads, const Positions& from, const Positions& to) {
  /// Sums over a garment.
  struct Sums {
    Eigen::RowVector3d load{0, 0, 0}, moved{0, 0, 0};
    double loads = 0, area = 0;
  };
  constexpr double rounding = 1e-9;  // a smaller part of all loads is no sum of them
  const std::vector<int> garment = component_numbers(level.topology);
  std::vector<Sums> garments(1 + *std::ranges::max_element(garment));
  for (int v = 0; v < level.vertex_count(); ++v) {
    Sums& own = garments[garment[v]];
    own.load += loads.row(v);
    own.loads += loads.row(v).norm();
    own.moved += level.vertex_area[v] * (to.row(v) - from.row(v));
    own.area += level.vertex_area[v];
  }
  double farthest = 0;
  for (const Sums& own : garments)
    if (own.load.norm() > rounding * own.loads)
      farthest = std::max(farthest, own.moved.dot(own.load.normalized()) / own.area);
  return farthest;
}

}  // namespace drape
