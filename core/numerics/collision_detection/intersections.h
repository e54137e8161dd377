#pragma once

#include <optional>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Two intersecting triangles.
struct TrianglePair {
  int first, second;
  Eigen::Vector3d where;  ///< a point near the intersection, within both bounding boxes [m]
};

/// Pairs first < second of one mesh's triangles that intersect or touch, by exact predicates, in order.
/// Triangles that share an edge intersect if they are coplanar and overlap; those that share a vertex, if
/// they meet elsewhere too (as in CGAL's self_intersections). A degenerate triangle counts as intersecting
/// every triangle whose bounding box its own overlaps. Throws std::runtime_error if more pairs
/// of boxes overlap than two million and 100 for each triangle.
std::vector<TrianglePair> self_intersections(const TriangleMesh& mesh);

/// Pairs of a triangle of one mesh and one of another that intersect or touch, by exact predicates, in order.
/// Throws as self_intersections.
std::vector<TrianglePair> intersections(const TriangleMesh& mesh, const TriangleMesh& other);

/// The first of these points [m] that is outside a closed surface or on it, by exact predicates; empty if all
/// are inside.
std::optional<Eigen::Index> first_outside(const TriangleMesh& closed, const Positions& points);

}  // namespace drape
