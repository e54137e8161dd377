#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

namespace drape {

/// The smallest gap of a state and the parameters of the barrier that acts on it.
struct SmallestGap {
  std::string between;  ///< "cloth triangle 12 and ball: sphere"; empty without a gap below d̂
  double gap = std::numeric_limits<double>::infinity();  ///< [m]
  double dhat = 0;                                       ///< d̂, below which the barrier acts [m]
  double stiffness = 0;                                  ///< κ of the barrier [Pa]
};

/// How far the cloth is from an obstacle.
struct ObstacleGap {
  std::string obstacle;       ///< its name in messages
  double gap = 0;             ///< the shortest distance [m]
  Eigen::Vector3d direction;  ///< unit, from the obstacle towards the cloth there
};

}  // namespace drape
