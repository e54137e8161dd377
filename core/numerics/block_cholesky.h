#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/numerics/block_matrix.h"

namespace drape {

/// Sparse Cholesky factorisation of a symmetric block matrix plus a diagonal, without the rows and
/// columns of fixed vertices (CHOLMOD, supernodal). The graph of vertices is ordered, not that of the
/// unknowns; order and symbolic factor are kept until the pattern or the fixed vertices change.
class BlockCholesky {
 public:
  BlockCholesky();
  ~BlockCholesky();
  BlockCholesky(const BlockCholesky&) = delete;
  BlockCholesky& operator=(const BlockCholesky&) = delete;

  /// Orders and analyses; does nothing when called again with the same pattern and flags.
  /// `fixed` has one flag a vertex. Throws std::runtime_error when memory runs out.
  void analyse(std::shared_ptr<const BlockPattern> pattern, const std::vector<char>& fixed);

  /// Factorises A + diag(shift_i I₃); shift has one entry a vertex [N/m]. False when the sum is not
  /// positive definite: there is no factor then.
  bool factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift);

  /// Solves with the last factor; n×3 right-hand side and solution, whose fixed rows are zero.
  void solve(const Positions& right_hand_side, Positions& solution);

  bool has_factor() const { return has_factor_; }
  int unknowns() const;
  /// Floating-point operations of one numeric factorisation, and entries of the factor.
  double flops() const;
  double factor_entries() const;
  /// How many times an analysis was made.
  int analyses() const { return analyses_; }

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> c_;
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<char> fixed_;
  std::vector<int> order_;  // order_[p] is the vertex at place p
  /// Where each block of the pattern goes in the factor's input.
  struct Target {
    int block;           // of the pattern
    bool transpose;      // whether the block is to be read transposed
    std::size_t offset;  // of its entry (0, 0)
    int stride;          // length of the block's first column; the next two are one and two shorter
  };
  std::vector<Target> off_diagonal_, diagonal_;
  bool has_factor_ = false;
  int analyses_ = 0;
};

/// Threads of the dense kernels under the factorisation, apart from thread_count(): their number changes
/// the order of sums, so that results are the same bits only for the same number. One by default; two make
/// a large factorisation about 1.5 times as fast where the cores are free, and slower where they are not.
void set_blas_threads(int threads);
int blas_threads();

}  // namespace drape
