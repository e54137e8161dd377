#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Edge length 1 m, centred at the origin, with outward normals. Bit k of a vertex's index chooses the sign
/// of its coordinate k.
TriangleMesh unit_box();
/// An icosphere of radius 1 m: a subdivided icosahedron with its vertices on the sphere.
TriangleMesh unit_sphere(int subdivisions);

}  // namespace drape
