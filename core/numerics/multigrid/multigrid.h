#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/prolongation_matrix.h"
#include "core/numerics/linear_algebra/block_cholesky.h"
#include "core/numerics/linear_algebra/block_matrix.h"
#include "core/numerics/linear_algebra/conjugate_gradients.h"
#include "core/numerics/multigrid/multigrid_mesh.h"

namespace drape {

/// Conjugate gradients on a block matrix plus a diagonal, without the rows and columns of fixed vertices,
/// preconditioned by one V-cycle of multigrid over the meshes of a hierarchy.
///
/// Coarse matrices are Galerkin products Pᵀ A P, so contacts are in them too; the coarsest is factorised.
/// Cycles are in single precision. Costs grow in proportion to the vertices, while those of a factorisation
/// grow with their power of 1.5. Gives the same bits with any number of threads.
class Multigrid {
 public:
  /// Meshes with fewer vertices need no coarser one: their matrix is factorised in milliseconds.
  static constexpr int small_mesh = 2000;

  /// `prolongations` lead from the coarsest mesh to the matrix's own, at least one. Need not outlive the
  /// object.
  explicit Multigrid(std::span<const ProlongationMatrix> prolongations);

  /// Forms the coarse matrices of A + diag(shift_i I₃); `fixed` has one flag a vertex. Refers to the matrix
  /// until the next call. Returns false if a block of a vertex or the coarsest matrix is not positive
  /// definite.
  bool set(const BlockMatrix& matrix, const Eigen::VectorXd& shift, const std::vector<char>& fixed);

  /// Solves to a relative residual of 0.1, with which Newton takes about as many iterations as with exact
  /// directions, or of 0.4 where cycles would take longer than a factorisation; not converged if that is not
  /// reached either. n×3 right-hand side and solution, whose fixed rows are zero.
  ConjugateGradients::End solve(const Positions& right_hand_side, Positions& solution);

  /// z = one V-cycle of the last set matrix on r, n×3, whose fixed rows are zero: a positive definite
  /// approximation of its inverse.
  void precondition(const Positions& r, Positions& z);

  /// Floating-point operations since the last call.
  double take_flops() { return std::exchange(flops_, 0); }

 private:
  void cycle(std::size_t mesh);

  std::deque<MultigridMesh> meshes_;  // finest first
  BlockMatrix coarsest_matrix_;
  BlockCholesky coarsest_;
  Positions right_, solution_;  // of the coarsest
  const BlockMatrix* matrix_ = nullptr;
  Eigen::VectorXd shift_;
  std::vector<char> fixed_;
  ConjugateGradients gradients_;
  double flops_ = 0;
};

}  // namespace drape
