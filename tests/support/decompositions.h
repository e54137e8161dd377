#pragma once

#include <Eigen/Core>

#include "core/kernel/interfaces/energy.h"

// Eigen's decompositions of matrices of any size, compiled once for all tests (tests/decompositions.cpp):
// each file that instantiates one takes seconds longer.

/// Eigenvalues of a symmetric matrix, in ascending order.
Eigen::VectorXd eigenvalues_of(const Eigen::MatrixXd& symmetric);

/// A symmetric matrix as vectors · diag(values) · vectorsᵀ, values in ascending order.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
Eigenpairs eigenpairs_of(const Eigen::MatrixXd& symmetric);

/// The matrix again, with its eigenvalues projected.
inline Eigen::MatrixXd recomposed(const Eigenpairs& eigen, drape::Projection projection) {
  Eigen::VectorXd values = eigen.values;
  const double blend = projection.blend;
  if (projection.kind == projection.clamp) values = (1 - blend) * values + blend * values.cwiseMax(0);
  if (projection.kind == projection.absolute) values = (1 - blend) * values + blend * values.cwiseAbs();
  return eigen.vectors * values.asDiagonal() * eigen.vectors.transpose();
}

/// Singular values, in descending order.
Eigen::VectorXd singular_values_of(const Eigen::MatrixXd& matrix);
