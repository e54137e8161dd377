#pragma once

#include <Eigen/Core>

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

/// Singular values, in descending order.
Eigen::VectorXd singular_values_of(const Eigen::MatrixXd& matrix);
