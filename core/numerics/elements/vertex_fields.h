#pragma once

#include <Eigen/Core>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// n mean curvatures H_i = ¼ Σ_e ‖e‖ θ_e / A_i [1/m] at positions x (n×3) [m], over the inner edges `hinges`
/// (h×4, Topology::hinges), θ_e > 0 where the surface is convex, A_i a third of the deformed triangles around
/// i (Knöppel et al. 2013); NaN where there is no area.
Eigen::VectorXd mean_curvature(const Positions& x, const Triangles& triangles, const Stencils& hinges);

/// n largest principal stretches of the triangles around each vertex [1], 0 at one without triangles.
Eigen::VectorXd largest_stretch(const Level& level, const Positions& x);

}  // namespace drape
