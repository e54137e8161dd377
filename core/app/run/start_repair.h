#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// Translates an initial state that intersects something, or is closer than a micrometre to it: up, or else
/// sideways, equally on every level, until nothing intersects and no obstacle is within d̂ or encloses the
/// cloth. Returns the translation [m], zero if none was necessary. It is added to the
/// experiment's `start.translate`, and the scene must be built again. Appends an error if no translation is
/// found or the cloth has pins.
Eigen::Vector3d repair_start(Experiment& experiment, const Scene& scene, ConfigErrors& errors);

}  // namespace drape
