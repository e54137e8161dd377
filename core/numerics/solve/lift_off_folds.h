#pragma once

#include <optional>

#include "core/numerics/model/level_model.h"

namespace drape {

/// A state without intersections near an interpolated one, whose triangles do not split the coarse ones: an
/// edge across a fold of the coarse surface passes on the fold's hollow side, and may meet there what lies in
/// the fold. Around each place that meets something, the cloth moves as a whole towards the outer side of the
/// fold there, smoothly in space, so that its layers keep their order; after some rounds towards the other
/// side. Nothing if exact tests still find a pair then.
std::optional<Positions> lifted_off_folds(const LevelModel& model, const Positions& interpolated);

}  // namespace drape
