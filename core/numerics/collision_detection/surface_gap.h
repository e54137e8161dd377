#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The shortest vector [m] to `mesh` from `other`, of those that begin or end at a vertex. Where two edges
/// are nearer than that, it is longer than the distance by less than an edge.
Eigen::Vector3d shortest_connection(const TriangleMesh& mesh, const TriangleMesh& other);

}  // namespace drape
