#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/linear_algebra/symmetric_eigen.h"

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

/// Projects many matrices with SIMD, native_pack_width at a time: matrix(i), i < count, each a
/// SymmetricMatrix<Size, double>&.
template <int Size, class Matrix>
void project_all(int count, Projection projection, const Matrix& matrix) {
  if (projection.is_exact()) return;
  constexpr int W = native_pack_width, entries = Size * (Size + 1) / 2;
  for (int first = 0; first < count; first += W) {
    SymmetricMatrix<Size, Pack<W>> pack;
    for (int lane = 0; lane < W; ++lane) {
      const auto& own = matrix(std::min(first + lane, count - 1)).upper;
      for (int e = 0; e < entries; ++e) pack.upper[e].v[lane] = own[e];
    }
    map_eigenvalues(pack, [projection](Pack<W> eigenvalue) { return projection.map(eigenvalue); });
    for (int lane = 0; lane < std::min(W, count - first); ++lane)
      for (int e = 0; e < entries; ++e) matrix(first + lane).upper[e] = pack.upper[e][lane];
  }
}

}  // namespace drape
