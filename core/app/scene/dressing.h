#pragma once

#include "core/app/scene/scene.h"

namespace drape {

/// Finds a start without intersections of a garment around its body: the placed garment smoothed, the body
/// contracted, each by little if that will do. Sets `dressing` and `starts` of the scene, whose models are
/// made. Appends an error that names the piece which every start leaves in the body, or in another piece, and
/// one for a body that is elsewhere.
void find_dressing_start(const Experiment& experiment, Scene& scene, ConfigErrors& errors);

}  // namespace drape
