#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "plugins/contact/shapes/solid.h"

namespace drape::shapes {

/// The corners and straight edges of a solid, rounded by `offset`, that the interior of a cloth edge or
/// triangle can make contact with: those of a cylinder's rims as polygons, and of its curved side its axis.
struct Features {
  double dhat = 0;                        ///< d̂ of their contacts [m]
  int first_point = 0;                    ///< index of the first point in SolidFeatures::points
  std::vector<Eigen::Vector3d> points;    ///< [m]
  std::vector<std::array<int, 2>> edges;  ///< indices of points
  double offset = 0;                      ///< [m]
  double side = 0;                        ///< side length of a rim's polygon [m]; 0 for other solids
  int sides = 0;                          ///< of a rim's polygon; 0 for other solids
  bool is_axis = false;                   ///< of a cylinder, whose radius is the offset

  /// The distance from points and edges within which contacts are [m].
  double reach() const { return dhat + offset; }

  /// Those of a solid for contacts within d̂. A cylinder has three: its axis, rims with few sides, and rims
  /// with many sides for gaps so small that few would be too far inside the circle.
  static std::vector<Features> of(const Solid& solid, double dhat);

  /// A lower bound of the distance of p from a cylinder's rims [m].
  double distance_bound(const Solid& solid, const Eigen::Vector3d& p) const;

  /// Appends the indices of points within `radius` of `centre`.
  void points_near(const Solid& solid, const Eigen::Vector3d& centre, double radius,
                   std::vector<int>& found) const;
  /// Appends the indices of edges within `radius` of `centre`.
  void edges_near(const Solid& solid, const Eigen::Vector3d& centre, double radius,
                  std::vector<int>& found) const;
};

/// Number of points of a cylinder's rims at this d̂ [m], as Features::of makes them.
long rim_points(const Solid& cylinder, double dhat);

/// Features of all solids, with their points in one matrix.
struct SolidFeatures {
  std::vector<std::vector<Features>> of_solid;  ///< by solid
  Positions points;                             ///< of all features, n×3 [m]

  static SolidFeatures of(const std::vector<Solid>& solids, double dhat);
};

/// Around a circle of each of so many solids for drawing: 64, and fewer where they would have more than about
/// 4 million triangles together; a multiple of 4.
int drawn_sides(std::size_t solids);

/// A closed surface for drawing, with `sides` around a circle, a multiple of 4; for a half-space a square of
/// half side length `half_side` [m].
TriangleMesh tessellate(const Solid& solid, double half_side, int sides);

}  // namespace drape::shapes
