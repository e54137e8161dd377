#pragma once

#include <Eigen/Core>
#include <atomic>
#include <vector>

#include "core/numerics/block_matrix.h"
#include "core/numerics/supernodal_front.h"
#include "core/numerics/supernodal_tree.h"

namespace drape {

/// Multifrontal Cholesky factorisation of a symmetric matrix of 3×3 blocks (Duff and Reid 1983; Liu 1992).
///
/// Every supernode, in postorder, gathers the matrix' entries in its columns and its children's update
/// matrices into its front, eliminates its own columns, and leaves its update matrix to its parent. Subtrees
/// are worked on in parallel, then the supernodes above them one by one, their fronts in parallel by tiles.
/// Tree, tiles and the order of the children do not depend on the number of threads, and an entry is only
/// ever changed by one thread at a time in one order: the factor is the same, bit by bit, with any number.
class SupernodalFactor {
 public:
  /// order[p] is the vertex at place p of the tree; vertices that are not in it are left out. Keeps the
  /// memory of an earlier layout where it suffices.
  void lay_out(SupernodalTree tree, const BlockPattern& pattern, const std::vector<int>& order);

  /// Factorises A + diag(shift_i I₃), shift by vertex. False, early, when a pivot is not positive.
  bool factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift);

  /// Solves in place; three unknowns a place.
  void solve(Eigen::VectorXd& x);

 private:
  /// A block of the matrix and its vertices in the front.
  struct Entry {
    int block, row, column;
    bool transposed;
  };

  Front front(int s);
  bool eliminate(int s, const BlockMatrix& matrix, const Eigen::VectorXd& shift);
  void assemble(int s, const Front& f, const BlockMatrix& matrix, const Eigen::VectorXd& shift);
  void forward(int s, const Eigen::VectorXd& x);
  void backward(int s, Eigen::VectorXd& x);

  SupernodalTree tree_;
  std::vector<int> order_;
  std::vector<int> entry_start_;  // of each supernode
  std::vector<Entry> entries_;
  Eigen::VectorXd panels_, updates_;
  std::vector<int> vector_start_;  // of each supernode's part of the solve's work space
  Eigen::VectorXd work_;
  std::atomic<bool> failed_ = false;
};

}  // namespace drape
