#pragma once

#include <limits>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

/// Bound on the round-off in the force on each vertex [N]:
///
///     b_i = u Σ_j ‖H_ij‖ ‖x_j‖,   u = 2⁻⁵³,
///
/// H the unprojected Hessian at x. A double represents an exact x_j to u ‖x_j‖ at best, and that error
/// changes the forces by the bound. Round-off within an element scales with the element's size in place of
/// ‖x_j‖ and is smaller. Errors partly cancel: at an equilibrium in doubles, forces are about a tenth of the
/// bound.
Eigen::VectorXd rounding_bounds(const BlockMatrix& hessian, const Positions& x);

/// Result of rounding_floor.
struct RoundingFloor {
  double norm = 0;       ///< norm of the bounds of free vertices [N]
  bool reached = false;  ///< whether the force on every free vertex is within its bound
};

/// The rounding floor at x (n×3) [m], with the unprojected Hessian [N/m] and the gradient (n×3) [N] there.
/// Skips fixed vertices (one flag a vertex).
RoundingFloor rounding_floor(const BlockMatrix& hessian, const Positions& x, const Positions& gradient,
                             const std::vector<char>& fixed);

/// Detects idle steps: ten consecutive ones with the same energy, whose force residual has not halved.
struct IdleSteps {
  int steps = 0;
  /// At the end of the last step that was not idle [J], [1].
  double energy = std::numeric_limits<double>::infinity(), residual = energy;

  /// Records the energy [J] and force residual at a step's end. Energies within `noise` [J] count as the
  /// same.
  void note(double new_energy, double new_residual, double noise);
  bool many() const { return steps >= 10; }
};

}  // namespace drape
