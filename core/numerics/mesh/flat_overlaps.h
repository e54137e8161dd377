#pragma once

#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Triangles of a flat mesh (all z = 0) that face the other way than the rest around an inner vertex and
/// overlap it, ascending: the angles of the triangles at that vertex, negative for those that face down, add
/// up to a full turn. In a mesh that is folded flat, as a cushion, they add up to 0. The mesh must have one
/// or two triangles at every edge, with the same front side. Empty for a mesh that is not flat.
std::vector<int> flat_overlaps(const TriangleMesh& mesh);

}  // namespace drape
