#pragma once

#include <limits>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/numerics/block_matrix.h"

namespace drape {

/// How large the forces on each vertex may be by rounding alone, where the exact ones are zero [N]:
///
///     b_i = u Σ_j ‖H_ij‖ ‖x_j‖,   u = 2⁻⁵³,
///
/// H the Hessian at x, not projected. No double is nearer to an exact x_j than u ‖x_j‖, which changes the
/// forces by as much. What rounding does within an element is of the same kind with its size in place of
/// ‖x_j‖, and smaller. Signs differ, so that forces at an equilibrium in doubles are about a tenth of it.
Eigen::VectorXd rounding_bounds(const BlockMatrix& hessian, const Positions& x);

struct RoundingFloor {
  double norm = 0;       ///< of the bounds of free vertices [N]
  bool reached = false;  ///< whether the force on every free vertex is within its bound
};

RoundingFloor rounding_floor(const BlockMatrix& hessian, const Positions& x, const Positions& gradient,
                             const std::vector<char>& fixed);

/// Notices steps that bring nothing: for several in turn the energy has stayed the same and the force
/// residual has not halved.
class IdleSteps {
 public:
  /// All that it remembers.
  struct Memory {
    int steps = 0;
    double energy = std::numeric_limits<double>::infinity();
    double residual = std::numeric_limits<double>::infinity();
  };
  Memory memory() const { return m_; }
  void restore(const Memory& memory) { m_ = memory; }

  /// A step has ended with these. Energies that differ by `noise` at most are the same.
  void note(double energy, double residual, double noise);
  bool many() const { return m_.steps >= most; }
  /// What is minimised is another function from now on, or the steps were found to be idle for a reason.
  void restart() { m_ = {}; }

 private:
  static constexpr int most = 10;
  Memory m_;
};

}  // namespace drape
