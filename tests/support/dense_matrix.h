#pragma once

#include <Eigen/Core>

#include "core/numerics/linear_algebra/block_matrix.h"

/// Both triangles of a block matrix, as an oracle for small cases.
inline Eigen::MatrixXd dense(const drape::BlockMatrix& m) {
  const int n = m.pattern->rows();
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int i = 0; i < n; ++i)
    for (int k = m.pattern->row_start[i]; k < m.pattern->row_start[i + 1]; ++k) {
      const int j = m.pattern->columns[k];
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> b(m.block(k));
      d.block<3, 3>(3 * i, 3 * j) = b;
      d.block<3, 3>(3 * j, 3 * i) = b.transpose();
    }
  return d;
}
