#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace drape {

/// Largest and smallest singular value of a deformation gradient [1].
struct PrincipalStretches {
  double largest, smallest;
};

/// Singular values of the 3×2 deformation gradient F that takes the rest triangle X to the deformed one x,
/// in closed form. The rest triangle must have an area; a collapsed deformed one has smallest = 0.
inline PrincipalStretches principal_stretches(const Eigen::Vector3d& rest0, const Eigen::Vector3d& rest1,
                                              const Eigen::Vector3d& rest2, const Eigen::Vector3d& x0,
                                              const Eigen::Vector3d& x1, const Eigen::Vector3d& x2) {
  // Rest edges in a frame along the first: (length, 0) and (along, across). F's columns follow by hand.
  const Eigen::Vector3d rest_edge = rest1 - rest0, rest_side = rest2 - rest0;
  const double length = rest_edge.norm();
  const double along = rest_edge.dot(rest_side) / length, across = rest_edge.cross(rest_side).norm() / length;
  const Eigen::Vector3d f1 = (x1 - x0) / length, f2 = ((x2 - x0) - along * f1) / across;

  // From σ₁σ₂ = ‖f1 × f2‖, σ₁² + σ₂² and σ₁² − σ₂²: no cancellation where the stretches nearly agree.
  const double product = f1.cross(f2).norm();
  const double a = f1.squaredNorm(), b = f2.squaredNorm();
  const double sum = std::sqrt(a + b + 2 * product);
  if (sum == 0) return {0, 0};
  const double difference = std::hypot(a - b, 2 * f1.dot(f2)) / sum;
  const double largest = 0.5 * (sum + difference);
  return {largest, product / largest};
}

}  // namespace drape
