#pragma once

#include "core/experiment/experiment.h"

namespace drape {

/// Moves a start that touches something, or is closer than a micrometre to it, the same way on every level:
/// up, or else to a side, until nothing touches and no obstacle is within d̂ or around the
/// cloth. Returns the way [m], zero where nothing had to be moved. It is added to the experiment's
/// `start.translate`, from which the scene is to be built again. Where a start that touches cannot be moved
/// apart, or has pins, errors say why.
Eigen::Vector3d repair_start(Experiment& experiment, const Scene& scene, ConfigErrors& errors);

}  // namespace drape
