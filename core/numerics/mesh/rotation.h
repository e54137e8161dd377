#pragma once

#include <Eigen/Geometry>

namespace drape {

/// The 3×3 matrix of the rotation about the x, then the y, then the z axis by these angles [degree].
inline Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& degrees) {
  const Eigen::Vector3d angle = degrees * (M_PI / 180);
  return (Eigen::AngleAxisd(angle.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angle.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angle.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace drape
