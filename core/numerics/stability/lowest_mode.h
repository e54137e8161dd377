#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The lowest value of the Rayleigh quotient vᵀAv / vᵀBv, and the vector that has it.
struct LowestMode {
  double value = 0;
  Positions vector;        ///< n×3, of vᵀBv = 1
  bool converged = false;  ///< the value had settled before the iterations ran out
};

/// A symmetric linear operator: overwrites y (n×3) with its product with x (n×3).
using LinearOperator = std::function<void(const Positions& x, Positions& y)>;

/// When lowest_mode ends.
struct ModeAccuracy {
  double relative_change;  ///< of the value in each of two iterations in a row
  double negligible;       ///< changes below this count as none
  double residual;         ///< bound on √(rᵀw), w the preconditioned residual r, relative to the value
  int max_iterations;
  int modes = 1;  ///< that settle, lowest first: a stiff one may rise from the noise after a soft one
  double below = std::numeric_limits<double>::infinity();  ///< the value is known to be below
};

/// The lowest mode of the pencil (A, B) by the generalised Davidson method (Morgan and Scott 1986): a
/// subspace grows by preconditioned residuals, and is cut to its lowest Ritz vectors where it becomes large.
/// With an exact A⁻¹ it is Lanczos' inverse iteration.
///
/// B and the preconditioner are positive definite, A need not be. Rows that the starts and the preconditioner
/// leave at zero stay there, so all operators may be given on the free vertices alone. The value is at most
/// the lowest quotient of the starts, of which one must not be orthogonal to the mode. Gives the same bits
/// with any number of threads if the operators do.
LowestMode lowest_mode(const LinearOperator& a, const LinearOperator& b, const LinearOperator& precondition,
                       const std::vector<Positions>& starts, const ModeAccuracy& accuracy);

}  // namespace drape
