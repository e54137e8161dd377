#pragma once

#include <Eigen/Core>

namespace drape {

/// The signed distance to an obstacle at a point: value, gradient and principal curvatures of the level set.
/// The distance's Hessian is curvature[0] a aᵀ + curvature[1] b bᵀ, a = tangent, b = normal × tangent.
struct SignedDistance {
  double distance = 0;                                 ///< [m]; negative inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< gradient, away from the obstacle
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();  ///< first principal direction, unit
  Eigen::Vector2d curvature =
      Eigen::Vector2d::Zero();  ///< [1/m]; ≥ 0 outside a convex obstacle, < 0 inside a hollow one
};

}  // namespace drape
