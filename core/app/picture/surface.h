#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// n×3 unit normals, area-weighted; zero where undefined.
Positions smooth_normals(const TriangleMesh& mesh);

/// A mesh whose triangles share no vertices, and its normals, n×3, unit length: smooth, but not across edges
/// with more than 40° between their triangles' normals.
TriangleMesh split_at_creases(const TriangleMesh& mesh, Positions& normals);

}  // namespace drape
