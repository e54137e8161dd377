#pragma once

#include <optional>

#include "core/app/experiment/experiment.h"

namespace drape {

/// The forces of the experiment's loads on a level at x (n×3), without handles [N].
Positions load_forces(const Experiment& experiment, const Level& level, const Positions& x);

/// The unit vector against the sum of forces (n×3); none if they have no sum.
std::optional<Eigen::RowVector3d> upward(const Positions& forces);

}  // namespace drape
