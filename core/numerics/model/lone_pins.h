#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/numerics/model/level_model.h"

namespace drape {

/// Vertices of a coarse level at which single points hold the cloth: those with a Dirichlet condition that no
/// neighbour has, here and on the finest level, which has them too. `finest` is not called for
/// a level without such vertices.
std::vector<int> lone_pins(const LevelModel& coarse,
                           const std::function<std::shared_ptr<const LevelModel>()>& finest);

/// Factor on the stiffness of each triangle of a level `levels_below` = k below the finest: below 1 around
/// lone pins, so that the level hangs from them as low as the finest one does (docs/theory/locking.md).
/// At a distance r below a point that holds the force F the strain is F / (E d θ r): θ = (α + sin α) / 2 for
/// cloth that fills an angle α at its border (Michell's wedge), 4π / ((3 - ν) (1 + ν)) inside the cloth
/// (Kelvin). So the cloth hangs lower by F ln 2 / (E d θ) with each refinement. This adds that compliance k
/// times to 1 / K, K the stiffness of the vertex between resting neighbours along the angle's axis, or its
/// mean inside the cloth (Timoshenko and Goodier 1970, sections 38 and 42).
Eigen::VectorXd softening_at_pins(const Level& level, const std::vector<int>& pins, double poisson_ratio,
                                  double levels_below);

}  // namespace drape
