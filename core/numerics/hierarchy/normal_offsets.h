#pragma once

#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/prolongation_matrix.h"

namespace drape {

/// What linear interpolation misses of a curved rest shape: how far each fine vertex rests above the coarse
/// triangle that carries it. In any state it stays as far above that triangle:
///   x_f = U x + height · n(x),  n the triangle's unit normal.
struct NormalOffsets {
  std::vector<int> triangle;  ///< the coarse triangle of each fine vertex; empty: there are no offsets
  Eigen::VectorXd height;     ///< along its normal [m]

  /// The offsets of weights that project the places of the fine vertices to the planes of coarse triangles.
  /// There are none where U X is the fine rest shape up to rounding, for sewn cloth, whose pieces rest flat,
  /// and for other weights, such as those in the plane of a cloth that is nearly flat.
  static NormalOffsets of(const Level& coarse, const ProlongationMatrix& weights, const Level& fine);

  /// Adds height · n(x) to `fine` = U x.
  void add(const Triangles& coarse, const Positions& x, Positions& fine) const;
  /// Adds (∂(height · n)/∂x)ᵀ fine_forces to `forces` = Uᵀ fine_forces.
  void add_forces(const Triangles& coarse, const Positions& x, const Positions& fine_forces,
                  Positions& forces) const;
};

}  // namespace drape
