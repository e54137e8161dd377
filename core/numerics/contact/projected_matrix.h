#pragma once

#include <Eigen/Eigenvalues>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// The symmetric matrix h with its eigenvalues projected, by Eigen; for a few small matrices at a time.
template <int Size>
Eigen::Matrix<double, Size, Size> projected_matrix(const Eigen::Matrix<double, Size, Size>& h,
                                                   Projection projection) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Size, Size>> eigen(h);
  Eigen::Matrix<double, Size, 1> values = eigen.eigenvalues();
  for (double& value : values) value = projection.map(value);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace drape
