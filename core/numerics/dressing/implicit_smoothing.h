#pragma once

#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The surface's area [m²].
double surface_area(const TriangleMesh& mesh);

/// The vertices of a mesh after one implicit step of mean curvature flow, (M + time L)⁻¹ M x, M a third of
/// the adjacent areas and L the cotangent Laplacian (Desbrun et al. 1999): limbs become thin, a torso keeps
/// about half of its width, and borders contract with the rest. `time` [m²]. Cotangents are clamped to
/// [0.05, 5], so that every vertex moves to a mean of vertices, however thin the triangles are.
Positions contracted(const TriangleMesh& mesh, double time);

/// (I + time L)⁻¹ x, L the graph's Laplacian: long edges share their length with their neighbours. n×3 [m];
/// `time` [1]. Vertices with a flag in `fixed`, which has n or none, stay.
Positions smoothed(const Triangles& triangles, const Positions& x, double time,
                   const std::vector<char>& fixed = {});

/// Every vertex moved by a distance [m] along its normal, the mean of those of its triangles by area; those
/// whose triangles cancel stay.
Positions inflated(const TriangleMesh& mesh, double distance);

}  // namespace drape
