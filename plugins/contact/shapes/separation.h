#pragma once

#include <array>

#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "plugins/contact/shapes/solid.h"

namespace drape::shapes {

/// Corners of a triangle [m].
using Corners = std::array<Eigen::Vector3d, 3>;

/// The separation along one unit normal [m], which points from the solid to the triangle: at most their
/// distance, negative if it does not separate them.
double separation_along(const Solid& solid, const Corners& triangle, const Eigen::Vector3d& normal);

/// The separating plane with the largest separation. It equals the distance, or is not positive if solid and
/// triangle touch or intersect.
///
/// The triangle's point nearest to a disjoint solid is either in its interior, and the normal is the
/// triangle's, or on an edge, and the normal is that of the edge's nearest point. Four normals therefore
/// suffice for any convex solid. An inaccurate normal only reduces the separation, which keeps the result
/// safe.
SeparatingPlane separate(const Solid& solid, const Corners& triangle);

/// Whether solid and triangle touch or intersect. Tests one cheap normal before `separate`.
bool intersects(const Solid& solid, const Corners& triangle);

/// The part of the linear motion `from` → `to` of a triangle that keeps at least `min_gap_fraction` of the
/// initial distance, by conservative advancement. The separation along a fixed normal is the minimum of three
/// linear functions of time, so that sliding along a face or a tangent plane costs nothing. Every iteration
/// is safe. It stops at 1.01 times the distance to keep, or after 128 iterations, which only long motions
/// that graze an edge or a curved side need.
double advance(const Solid& solid, const Corners& from, const Corners& to, double min_gap_fraction);

}  // namespace drape::shapes
