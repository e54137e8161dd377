#pragma once

#include <string>
#include <vector>

#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// How far the cloth is from an obstacle.
struct ObstacleGap {
  std::string obstacle;       ///< its name in messages
  double gap = 0;             ///< the shortest distance [m]
  Eigen::Vector3d direction;  ///< unit, from the obstacle towards the cloth there
};

/// Optional interface of a BoundContact that knows the distances to its obstacles, however far they are.
class ObstacleGapProvider {
 public:
  virtual ~ObstacleGapProvider() = default;
  /// The gap of each obstacle at x (n×3), which must be free of intersections, in the order of obstacles().
  virtual std::vector<ObstacleGap> obstacle_gaps(const Positions& x) const = 0;
};

}  // namespace drape
