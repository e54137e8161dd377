#include "core/numerics/elements/stretch.h"

#include <stdexcept>
#include <string>

namespace drape {

RestTriangle RestTriangle::of(const Level& level, int t) {
  const Eigen::Matrix3d x = rest_corners(level.rest, t);
  RestTriangle triangle = of(x.col(1) - x.col(0), Eigen::Vector3d(x.col(2) - x.col(0)));
  if (!(triangle.area > 0) || !std::isfinite(triangle.a + triangle.b + triangle.c))
    throw std::runtime_error("triangle " + std::to_string(t) + " of level " + std::to_string(level.index) +
                             " has no area at rest");
  if (level.softening.size() > 0) triangle.area *= level.softening[t];
  return triangle;
}

}  // namespace drape
