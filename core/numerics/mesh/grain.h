#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The direction of warp of each triangle at rest, m×3 unit vectors in the triangles' planes. Where the axis
/// is a triangle's normal, the next axis of the frame stands for it; where texture coordinates have no area,
/// the x axis.
Positions warp_directions(const TriangleMesh& rest);

/// The first triangle in which the mesh's grain has no direction, and why; empty without a grain.
std::vector<std::string> grain_faults(const TriangleMesh& rest);

}  // namespace drape
