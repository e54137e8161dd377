#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

constexpr int vertices_at_once = 8192;  ///< of a thread's piece of work

/// Σ a_i · b_i of n×3 a and b, with the same bits on any number of threads.
double inner_product(const Positions& a, const Positions& b);

/// Calls body(i) for each row i of x (n×3), in parallel.
template <class Body>
void for_each_vertex(const Positions& x, const Body& body) {
  parallel_for(static_cast<int>(x.rows()), vertices_at_once, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) body(i);
  });
}

/// Overwrites y (n×3) with (A + diag(shift_i I₃)) x (n×3), without a shift if that is empty, and with zero on
/// `fixed` vertices (one flag a vertex).
void multiply_free(const BlockMatrix& matrix, const Eigen::VectorXd& shift, const std::vector<char>& fixed,
                   const Positions& x, Positions& y);

/// Preconditioned conjugate gradients in double precision (Hestenes and Stiefel 1952). Keeps its work space
/// between solves. Gives the same bits with any number of threads.
class ConjugateGradients {
 public:
  enum class End {
    converged,
    not_definite,  ///< a direction has no positive curvature, or the preconditioner is not definite
    not_converged
  };

  /// When a solve ends, by the relative residual ‖b − A x‖ / ‖b‖.
  struct Accuracy {
    double tolerance;    ///< the residual that is wanted
    int max_iterations;  ///< for it
    double sufficient;   ///< the residual that counts as converged after max_iterations, ≥ tolerance
  };

  /// z = M⁻¹ r for n×3 r and z, whose fixed rows are zero.
  using Precondition = std::function<void(const Positions& r, Positions& z)>;

  /// Solves (A + diag(shift_i I₃)) x = b on the vertices that are not `fixed` (one flag a vertex). Rows of x
  /// for fixed vertices are zero.
  End solve(const BlockMatrix& matrix, const Eigen::VectorXd& shift, const std::vector<char>& fixed,
            const Positions& b, const Precondition& precondition, const Accuracy& accuracy, Positions& x);

 private:
  Positions r_, z_, p_, ap_;
};

}  // namespace drape
