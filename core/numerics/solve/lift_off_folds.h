#pragma once

#include <optional>

#include "core/numerics/model/level_model.h"

namespace drape {

/// A state without intersections near an interpolated one, whose triangles do not split the coarse ones: an
/// edge across a fold of the coarse surface passes on the fold's hollow side, and may meet there what lies in
/// the fold. Where it meets an obstacle, the cloth around moves as a whole towards the outer side of the
/// fold, smoothly in space, so that its layers keep their order; in a round that leaves no fewer meetings so,
/// towards the other side. Where two layers of cloth meet, they are drawn apart. Nothing if exact tests still
/// find a pair after some rounds.
std::optional<Positions> lifted_off_folds(const LevelModel& model, const Positions& interpolated);

}  // namespace drape
