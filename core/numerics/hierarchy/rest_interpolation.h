#pragma once

#include <limits>

#include "core/kernel/interfaces/refiner.h"

namespace drape {

/// A point as a combination of a triangle's corners.
struct EmbeddedPoint {
  int triangle = -1;
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();          ///< barycentric, of its projection to the plane
  double distance = std::numeric_limits<double>::infinity();  ///< from the triangle [m]

  static EmbeddedPoint of(const Eigen::Vector3d& point, const Positions& vertices, const Triangles& triangles,
                          int triangle);
};

/// Linear interpolation over the coarse rest shape (n_f × n_c, rows sum to 1).
///
/// Each fine vertex follows the coarse triangle that contains its rest position, or the nearest one. A
/// prolonged state therefore keeps its strains. `fine_rest` (n_f × 3) [m] is in the order of split_triangles.
/// A fine vertex that rests at its parent, or at the midpoint of its parent edge, gets its row of
/// midpoint_weights.
ProlongationMatrix rest_interpolation(const Level& coarse, const Positions& fine_rest);

}  // namespace drape
