#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/patterns/generate.h"

namespace drape {

/// Meshes the region within loops of points with triangles of about `edge_length` [m]: the loops' points are
/// the first vertices, in their order, and no vertex is added between them. No two sides of the loops may
/// meet but at their ends, and every hole lies in the first loop. A mirrored region has a mirrored mesh.
TriangleMesh mesh_panel(const std::vector<Polygon>& loops, double edge_length);

/// Whether a point lies in the loop, by the parity of its sides on one side of the point.
bool is_inside(const Polygon& loop, const Eigen::Vector2d& point);

}  // namespace drape
