#pragma once

#include "core/mesh/triangle_mesh.h"

namespace drape {

/// Whether two meshes have the same triangles in the same order; they may differ in number, where Eigen's ==
/// reads beyond the smaller one.
inline bool same_triangles(const Triangles& a, const Triangles& b) { return a.rows() == b.rows() && a == b; }

}  // namespace drape
