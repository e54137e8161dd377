#pragma once

#include "core/app/scene/scene.h"

namespace drape {

/// Translates a start that intersects something, or is closer than a micrometre to it: up, or else
/// sideways, equally on every level, until nothing intersects, no obstacle encloses the cloth and as few
/// obstacles as possible are within d̂. Returns the translation [m], zero if none was necessary. It is added
/// to the experiment's `start.translate`, and the caller must build the scene again. Appends an error if no
/// translation is found, or if an intersecting cloth has pins.
Eigen::Vector3d repair_start(Experiment& experiment, const Scene& scene, ConfigErrors& errors);

}  // namespace drape
