#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

/// How Newton's linear systems are solved. BlockCholesky has the last three.
enum class LinearSolver {
  automatic,   ///< multigrid on large meshes of a hierarchy, else mixed
  multigrid,   ///< Multigrid
  mixed,       ///< SupernodalFactor in single precision as preconditioner of conjugate gradients in double
  supernodal,  ///< SupernodalFactor in double precision
  cholmod      ///< CHOLMOD's factor, with the BLAS and LAPACK that the machine has
};

/// Supernodes of the Cholesky factor of a graph of vertices, in postorder.
struct Supernodes {
  std::vector<int> first;  ///< supernode s eliminates the positions first[s] … first[s + 1] - 1
  AdjacencyList rows;      ///< of each supernode the positions of its columns' other rows, ascending
};

/// Numeric Cholesky factorisation LLᵀ of a symmetric matrix of 3×3 blocks in a given order of elimination.
///
/// BlockCholesky orders and analyses; an implementation only factorises and solves.
class NumericFactor {
 public:
  virtual ~NumericFactor() = default;

  /// Sets the symbolic structure. ordering[p] is the vertex at position p, in a postorder of the elimination
  /// tree; vertices without a position are left out. Throws std::bad_alloc or std::runtime_error when memory
  /// runs out.
  virtual void set_structure(const BlockPattern& pattern, const std::vector<int>& ordering,
                             Supernodes supernodes) = 0;

  /// Factorises A + diag(shift_i I₃), shift by vertex [N/m]. Returns false, without a factor, if the sum is
  /// not positive definite.
  virtual bool factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift) = 0;

  /// Solves in place with the last factor; three unknowns for each position.
  virtual void solve(Eigen::VectorXd& x) = 0;
};

/// The position of each vertex in an ordering; -1 without one.
inline std::vector<int> positions_in(const std::vector<int>& ordering, int vertices) {
  std::vector<int> position(vertices, -1);
  for (std::size_t p = 0; p < ordering.size(); ++p) position[ordering[p]] = static_cast<int>(p);
  return position;
}

/// Calls visit(column, row, block, transposed) for each block of the permuted matrix' lower triangle: its
/// positions, column ≤ row, and where it is stored, possibly transposed.
template <class Visit>
void for_each_lower_block(const BlockPattern& pattern, const std::vector<int>& position, const Visit& visit) {
  pattern.for_each_block([&](int i, int j, int b) {
    if (const int p = position[i], q = position[j]; p >= 0 && q >= 0)
      visit(std::min(p, q), std::max(p, q), b, p < q);
  });
}

}  // namespace drape
