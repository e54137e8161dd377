#pragma once

#include <Eigen/Core>

#include "core/kernel/interfaces/topology.h"
#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Curvatures at each vertex of a triangle mesh. A sphere of radius R whose triangles face outward has
/// κ1 = κ2 = H = 1/R and K = 1/R²; turning all triangles over changes the sign of H, κ1, κ2 and not of K.
struct VertexCurvatures {
  Eigen::VectorXd mean;       ///< n, H = (κ1 + κ2)/2 [1/m]
  Eigen::VectorXd gaussian;   ///< n, K = κ1 κ2 [1/m²]
  Eigen::VectorXd strongest;  ///< n, the larger of κ1 and κ2 in magnitude, with its sign [1/m]; of fits only
};

/// Curvatures of the quadric z = a u² + b uv + c v² + d u + e v, fitted by least squares to the vertices
/// within `rings` ≥ 1 edges of each vertex whose normals do not oppose its own (Panozzo et al. 2010, as in
/// libigl's principal_curvature; departures in README.md). Throws std::runtime_error naming the vertex
/// where the normals of the triangles around it add up to none.
VertexCurvatures fit_curvatures(const Positions& x, const Triangles& triangles, const Topology& topology,
                                int rings);

/// Discrete differential curvatures: H_i = ¼ Σ_e ‖e‖ θ_e / A_i over the inner edges at i, θ_e > 0 where the
/// surface is convex (Knöppel et al. 2013); K_i = (2π − Σ angles)/A_i, π for 2π on the border (Meyer et al.
/// 2002); A_i a third of the deformed triangles around i.
/// Throws std::runtime_error naming the vertex where A_i is not positive.
VertexCurvatures ddg_curvatures(const Positions& x, const Triangles& triangles, const Topology& topology);

}  // namespace drape
