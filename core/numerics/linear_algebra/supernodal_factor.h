#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/linear_algebra/numeric_factor.h"
#include "core/numerics/linear_algebra/supernodal_front.h"
#include "core/numerics/linear_algebra/supernodal_tree.h"

namespace drape {

/// Multifrontal Cholesky factorisation of a symmetric matrix of 3×3 blocks (Duff and Reid 1983; Liu 1992).
///
/// In postorder, every supernode assembles its front from the matrix' entries and its children's update
/// matrices, eliminates its pivots, and passes its update matrix to its parent. Subtrees run in parallel;
/// then the supernodes above them one by one, their fronts in parallel by tiles. Tree, tiles and the order of
/// additions do not depend on the number of threads, so the factor is bitwise reproducible.
///
/// Scalar is double or float. In float a matrix that is definite to a ten-millionth or so may be refused, and
/// one that is not may be accepted.
template <class Scalar>
class SupernodalFactor : public NumericFactor {
 public:
  /// Reuses the memory of an earlier structure if it suffices.
  void set_structure(const BlockPattern& pattern, const std::vector<int>& ordering,
                     Supernodes supernodes) override;
  /// Returns false as soon as a pivot is not positive.
  bool factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift) override;
  void solve(Eigen::VectorXd& x) override;

 private:
  /// A block of the matrix and its vertices in the front.
  struct Entry {
    int block, row, column;
    bool transposed;
  };

  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  Front<Scalar> front(int s);
  void assemble(int s, const Front<Scalar>& f, const BlockMatrix& matrix, const Eigen::VectorXd& shift);
  void forward(int s, const Eigen::VectorXd& x);
  void backward(int s, Eigen::VectorXd& x);

  SupernodalTree tree_;
  std::vector<int> ordering_;
  Grouped<Entry> entries_;  // of each supernode
  Vector panels_, updates_;
  std::vector<int> vector_start_;  // of each supernode's work space in a solve
  Vector work_;
};

}  // namespace drape
