#pragma once

#include <array>

#include "plugins/contact/shapes/solid.h"

namespace drape {

/// Corners of a triangle [m].
using Corners = std::array<Eigen::Vector3d, 3>;

/// A plane between a solid and a triangle, and how wide a slab along its normal is empty: never more than
/// their distance, whatever the normal. Negative where the normal does not separate them.
struct Separation {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< from the solid to the triangle
  double gap = 0;                                     ///< [m]
};

/// The slab's width for one normal.
double slab(const Solid& solid, const Corners& triangle, const Eigen::Vector3d& normal);

/// The widest slab; its width is the distance, or not positive where solid and triangle touch or intersect.
///
/// If they are apart, the nearest point of the triangle is inside it, and then the normal is the triangle's
/// own, or on an edge, and then it is where that edge is nearest. So four normals are enough for any convex
/// solid. Rounding only ever narrows the slab: the answer is safe however inaccurate the normals are.
Separation separate(const Solid& solid, const Corners& triangle);

/// Whether solid and triangle touch or intersect: `separate` with a cheap look first.
bool touches(const Solid& solid, const Corners& triangle);

/// The part of the straight way from `from` to `to` on which the triangle's distance stays at least `keep` of
/// what it is at the start. Conservative advancement by slabs: a slab's width along the way is the smallest
/// of three linear functions, so sliding along a face or a tangent plane costs nothing. Every
/// round is safe; it ends where the distance is below 1.01 of what is to be kept, and after 128 rounds, which
/// only long ways that graze an edge or a curved side come near.
double advance(const Solid& solid, const Corners& from, const Corners& to, double keep);

}  // namespace drape
