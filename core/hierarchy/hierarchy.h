#pragma once

#include <vector>

#include "core/model/refiner.h"

namespace drape {

/// How the vertices of a finer level follow from a coarse one's.
enum class Interpolation {
  midpoint,  ///< linear in the rest shape: new vertices lie in the middle of edges, if they rest there
  refiner    ///< by the hierarchy's refiner
};

/// Levels of one cloth from coarse to fine, and the operators between them. Immutable once made.
struct Hierarchy {
  std::vector<Level> levels;                      ///< at least one
  std::vector<ProlongationMatrix> prolongations;  ///< [l]: P_{l→l+1} of the chosen refiner
  std::vector<ProlongationMatrix> midpoints;      ///< [l]: U_{l→l+1}, which leaves the surface in place
  /// [l]: linear interpolation over the rest shape: a fine vertex follows the coarse triangle that it rests
  /// in. The midpoints where the refiner leaves rest positions in place.
  std::vector<ProlongationMatrix> linear;

  /// Refines `coarsest` level_count - 1 times. Rest positions follow the same operator, X_{l+1} = P X_l,
  /// so that the rest shape is free of stress on every level. Throws std::runtime_error with the first
  /// fault of check_mesh, if any level has one, and on fewer than one level.
  static Hierarchy of(TriangleMesh coarsest, const Refiner& refiner, int level_count);

  const std::vector<ProlongationMatrix>& weights(Interpolation interpolation) const {
    return interpolation == Interpolation::midpoint ? linear : prolongations;
  }
  int level_count() const { return static_cast<int>(levels.size()); }

  /// W_{to-1} ⋯ W_{from} x by the given weights, [l]: n_{l+1} × n_l, for x (n_from × 3) and
  /// 0 ≤ from ≤ to < level_count().
  Positions prolong(const Positions& x, int from, int to,
                    const std::vector<ProlongationMatrix>& weights) const;
};

}  // namespace drape
