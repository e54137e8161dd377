#pragma once

#include <functional>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Triangles of a level with so many vertices; null if there is none.
using TrianglesOfLevel = std::function<const Triangles*(Eigen::Index vertex_count)>;

/// Splits a state 1→4 at edge midpoints, which leaves its surface as it is, until it has as many vertices as
/// `count`; the last level's triangles are `finest`. Interpolates the normals (n×3) too. Relies on the
/// numbering of Refinement: old vertices first, then one per edge. False if the numbers do not fit or the
/// triangles of an intermediate level are not known.
bool split_to(Eigen::Index count, const Triangles& finest, const TrianglesOfLevel& triangles_of,
              TriangleMesh& mesh, Positions& normals);

}  // namespace drape
