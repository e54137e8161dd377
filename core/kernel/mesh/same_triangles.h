#pragma once

#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// Whether two meshes have the same triangles in the same order. Unlike Eigen's ==, it accepts different
/// sizes.
inline bool same_triangles(const Triangles& a, const Triangles& b) { return a.rows() == b.rows() && a == b; }

}  // namespace drape
