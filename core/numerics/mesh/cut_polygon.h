#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace drape {

/// The triangles of a polygon, as indices of its corners, or why it has none.
struct CutPolygon {
  std::vector<std::array<int, 3>> triangles;
  std::string fault;  ///< continues "face 3 "; empty if the polygon was cut
};

/// Cuts a polygon of n ≥ 3 corners [m] into n - 2 triangles that face as it does: a fan around corner 0 if
/// each triangle of it faces so, as in every convex polygon, unless its corners are very many, and as
/// delaunay_cut does otherwise. A polygon without area is cut as a fan too, and a corner at the place of the
/// one before gets a triangle without area. Refuses a polygon whose corners lie off its mean plane by more
/// than 8 % of its diameter, and one that crosses or touches itself but along the way to a hole and back.
CutPolygon cut_polygon(const std::vector<Eigen::Vector3d>& corners);

/// The constrained Delaunay triangulation of what an outline of n corners encloses, anticlockwise: n - 2
/// triangles, or none if its sides cross, or touch elsewhere than along the way to a hole and back. Corners
/// at one place are all named by the first of them.
std::vector<std::array<int, 3>> delaunay_cut(const std::vector<Eigen::Vector2d>& outline);

}  // namespace drape
