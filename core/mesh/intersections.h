#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace drape {

/// Two triangles that meet where they should not.
struct TrianglePair {
  int first, second;
  Eigen::Vector3d where;  ///< near where they meet, within both their boxes [m]
  bool operator==(const TrianglePair&) const = default;
};

/// Pairs first < second of one mesh's triangles that intersect or touch, by exact predicates, in order.
/// Triangles that share an edge count where they lie in one plane and overlap, triangles that share a vertex
/// where they meet elsewhere too (as CGAL's self_intersections has it). A triangle without area counts as
/// meeting all whose boxes its own overlaps.
std::vector<TrianglePair> self_intersections(const TriangleMesh& mesh);

/// Pairs of a triangle of one mesh and one of another that intersect or touch, by exact predicates, in order.
std::vector<TrianglePair> intersections(const TriangleMesh& mesh, const TriangleMesh& other);

}  // namespace drape
