#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "plugins/contact/shapes/solid.h"

namespace drape {

/// What of a solid can touch the inside of a cloth's edge or triangle: corners and straight edges, each
/// `offset` thick. Of a cylinder it is those of a prism that is inscribed in it.
struct Features {
  Positions points;                                   ///< k×3 [m]
  Eigen::Matrix<int, Eigen::Dynamic, 2> edges{0, 2};  ///< e×2, indices of points
  double offset = 0;                                  ///< [m]
  double side = 0;  ///< of the prism's polygons, the length of a side [m]; 0 for other solids

  /// With a prism that is nowhere more than `slack` [m] inside its cylinder.
  static Features of(const Solid& solid, double slack);

  /// Appends the points within `radius` of `centre`.
  void points_near(const Solid& solid, const Eigen::Vector3d& centre, double radius,
                   std::vector<int>& found) const;
  /// The same with edges.
  void edges_near(const Solid& solid, const Eigen::Vector3d& centre, double radius,
                  std::vector<int>& found) const;
};

/// A closed surface to be drawn; of a half-space a square with this half side [m].
TriangleMesh tessellate(const Solid& solid, double half_side);

}  // namespace drape
