#pragma once

#include "core/app/scene/scene.h"

namespace drape {

/// Finds a start without intersections of a garment around its body: the placed garment smoothed, the body
/// contracted, each by little if that will do. Sets `dressing` and `starts` of the scene, whose models are
/// made. Appends an error that names the piece which every start leaves in the body, or in another piece, and
/// one for a body that is elsewhere.
void find_dressing_start(const Experiment& experiment, Scene& scene, ConfigErrors& errors);

/// Why a garment at x is too tight for a body that grows inside it: as it was placed, at rest on this level,
/// the body stretches it. Empty for one that is not.
std::string too_tight_as_placed(const ClothParameters& cloth, const Level& placed, const Positions& x);

/// Why a garment that is sewn at x is too tight for its body; empty for one that is not.
std::string too_tight_as_sewn(const ClothParameters& cloth, const DressParameters& dress, const Level& level,
                              const Positions& x);

}  // namespace drape
