#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/linear_algebra/block_matrix.h"
#include "core/numerics/linear_algebra/conjugate_gradients.h"
#include "core/numerics/linear_algebra/numeric_factor.h"

namespace drape {

/// Sparse Cholesky factorisation of a symmetric block matrix plus a diagonal, without the rows and columns of
/// fixed vertices.
///
/// CHOLMOD orders vertices by nested dissection (METIS) and forms supernodes (Chen, Davis, Hager and
/// Rajamanickam 2008); a NumericFactor does the numeric factorisation. A new pattern gets a new symbolic
/// analysis but reuses the ordering, until that costs too much or the fixed vertices change. Ordering, counts
/// and Analysis are the same for every LinearSolver.
///
/// LinearSolver::mixed takes half the time and memory to factorise. In single precision a factor may be
/// accepted of a matrix that is not positive definite, or refused of one that is nearly singular, so both
/// factorise and solve say only whether it serves.
class BlockCholesky {
 public:
  explicit BlockCholesky(LinearSolver solver = LinearSolver::supernodal);

  /// Changes to another implementation, which has no factor yet. Keeps the analysis.
  void use(LinearSolver solver);

  /// Input and result of a symbolic analysis. With the same pattern it gives the same layout.
  struct Analysis {
    std::vector<char> fixed;           ///< one flag a vertex; empty before the first
    std::vector<int> reused_ordering;  ///< of the free vertices from before; empty if it was computed
    std::vector<int> ordering;         ///< the resulting one: the vertex at each position
    double ordering_flops = 0;         ///< CHOLMOD's cost of a factorisation when the ordering was computed
    int count = 0;                     ///< analyses so far, including this one
  };

  /// Orders and analyses; does nothing when called again with the same pattern and flags.
  /// `fixed` has one flag a vertex. Throws std::runtime_error when memory runs out.
  void analyse(std::shared_ptr<const BlockPattern> pattern, const std::vector<char>& fixed);

  /// Factorises A + diag(shift_i I₃); shift has one entry a vertex [N/m]. Returns false, without a factor, if
  /// the sum is not positive definite. `mixed` refers to the matrix until it is called again.
  bool factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift);

  /// Solves with the last factor; n×3 right-hand side and solution, whose fixed rows are zero. Returns false,
  /// with `mixed` only, if conjugate gradients find that the matrix is not definite or do not converge.
  bool solve(const Positions& right_hand_side, Positions& solution);

  const Analysis& analysis() const { return analysis_; }
  /// Restores the layout that this analysis of the pattern gave, without a factor. If the pattern is null,
  /// since it was invalidated, restores only the ordering for the next analysis; if the analysis was
  /// forgotten, only the count.
  void restore(std::shared_ptr<const BlockPattern> pattern, Analysis analysis);

  /// Drops the factor and the ordering: the next analysis does not depend on the ones before.
  void forget();
  /// Whether there is an ordering that the next analysis may reuse.
  bool is_analysed() const { return !analysis_.fixed.empty(); }

  int unknowns() const { return 3 * static_cast<int>(analysis_.ordering.size()); }
  /// Floating-point operations of one numeric factorisation, without the explicit zeros of supernodes.
  double flops() const { return flops_; }

 private:
  /// Uses `ordering` if the factorisation then costs at most `max_flops`, else computes one.
  void order_and_analyse(std::vector<int> ordering, double max_flops);
  void set_structure();
  void apply_factor(const Positions& right_hand_side, Positions& solution);

  LinearSolver solver_;
  std::shared_ptr<const BlockPattern> pattern_;
  Analysis analysis_;
  Supernodes supernodes_;
  std::unique_ptr<NumericFactor> factor_;
  Eigen::VectorXd x_;
  // What conjugate gradients solve with the factor as preconditioner.
  const BlockMatrix* matrix_ = nullptr;
  Eigen::VectorXd shift_;
  ConjugateGradients gradients_;
  double flops_ = 0, entries_ = 0;
  bool has_factor_ = false;
};

}  // namespace drape
