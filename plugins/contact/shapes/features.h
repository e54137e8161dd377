#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "plugins/contact/shapes/solid.h"

namespace drape::shapes {

/// The corners and straight edges of a solid, rounded by `offset`, that the interior of a cloth edge or
/// triangle can make contact with. Those of a cylinder are its rims, as polygons; the curved side is at the
/// radius from its axis, the last two points.
struct Features {
  std::vector<Eigen::Vector3d> points;    ///< [m]
  std::vector<std::array<int, 2>> edges;  ///< indices of points
  double offset = 0;                      ///< [m]
  double side = 0;                        ///< side length of a rim's polygon [m]; 0 for other solids
  int sides = 0;                          ///< of a rim's polygon; 0 for other solids

  /// A rim's polygon is nowhere more than `max_inset` [m] inside its circle.
  static Features of(const Solid& solid, double max_inset);

  /// Appends the indices of points within `radius` of `centre`.
  void points_near(const Solid& solid, const Eigen::Vector3d& centre, double radius,
                   std::vector<int>& found) const;
  /// Appends the indices of edges within `radius` of `centre`.
  void edges_near(const Solid& solid, const Eigen::Vector3d& centre, double radius,
                  std::vector<int>& found) const;
};

/// A closed surface for drawing; for a half-space a square of half side length `half_side` [m].
TriangleMesh tessellate(const Solid& solid, double half_side);

}  // namespace drape::shapes
