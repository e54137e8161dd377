#pragma once

#include <vector>

#include "core/numerics/model/level_model.h"

namespace drape {

/// Vertices of a coarse level at which single points hold the cloth: those with a Dirichlet condition that no
/// neighbour has, of pins that hold as many vertices on the finest level.
std::vector<int> lone_pins(const LevelModel& coarse, const LevelModel& finest);

/// Factor on the stiffness of each triangle of a level `levels_below` = k below the finest: below 1 around
/// lone pins, so that the level hangs from them as low as the finest one does (docs/theory/locking.md).
/// Below a point that holds the force F the tension is F / (θ r) at a distance r, θ = (α + sin α) / 2 for
/// cloth that fills an angle α there (Michell's wedge; Timoshenko and Goodier 1951, section 38). So the cloth
/// hangs lower by F ln 2 / (E d θ) with each refinement. This adds that compliance k times to 1 / K, K the
/// stiffness of the vertex between resting neighbours along the angle's axis, or its mean inside the cloth.
Eigen::VectorXd softening_at_pins(const Level& level, const std::vector<int>& pins, double poisson_ratio,
                                  int levels_below);

}  // namespace drape
