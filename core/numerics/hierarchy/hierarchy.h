#pragma once

#include <vector>

#include "core/kernel/interfaces/refiner.h"

namespace drape {

/// Levels of one cloth from coarse to fine, and the operators between them. Immutable.
struct Hierarchy {
  std::vector<Level> levels;                      ///< at least one
  std::vector<ProlongationMatrix> prolongations;  ///< [l]: P_{l→l+1} of the chosen refiner
  std::vector<ProlongationMatrix> midpoints;      ///< [l]: U_{l→l+1}, which does not move the surface
  /// [l]: linear interpolation over the rest shape: each fine vertex follows the coarse triangle that
  /// contains its rest position. Equals the midpoint weights wherever the refiner does not move rest
  /// positions.
  std::vector<ProlongationMatrix> linear;

  /// Refines `coarsest` level_count - 1 times. Rest positions follow the same operator, X_{l+1} = P X_l,
  /// which keeps the rest shape stress-free on every level; texture coordinates are refined linearly. Throws
  /// std::runtime_error with the first fault of check_mesh on any level, and if level_count < 1.
  static Hierarchy of(TriangleMesh coarsest, const Refiner& refiner, int level_count);

  const std::vector<ProlongationMatrix>& weights(Interpolation interpolation) const {
    return interpolation == Interpolation::midpoint ? linear : prolongations;
  }
  int level_count() const { return static_cast<int>(levels.size()); }

  /// W_{to-1} ⋯ W_{from} x for x (n_from × 3) and weights [l]: n_{l+1} × n_l; 0 ≤ from ≤ to < level_count().
  Positions prolong(const Positions& x, int from, int to,
                    const std::vector<ProlongationMatrix>& weights) const;
};

}  // namespace drape
