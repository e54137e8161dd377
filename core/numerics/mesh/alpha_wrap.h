#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// A closed surface, free of self-intersections, at a distance of `offset` [m] around a mesh. It closes holes
/// that a ball of radius `alpha` [m] cannot enter (Portaneri et al. 2022, by CGAL).
TriangleMesh alpha_wrap(const TriangleMesh& mesh, double alpha, double offset);

}  // namespace drape
