#pragma once

#include <optional>

#include "core/numerics/model/level_model.h"

namespace drape {

/// A state without intersections near an interpolated one, whose triangles do not split the coarse ones: an
/// edge across a fold of the coarse surface passes on the fold's hollow side, and may meet there what lies in
/// the fold. Near each pair that meets, free vertices move to the outer sides of their folds, or back, by the
/// amounts that leave the fewest pairs, until exact tests find none. Nothing if that comes to no end.
std::optional<Positions> lifted_off_folds(const LevelModel& model, const Positions& interpolated);

}  // namespace drape
