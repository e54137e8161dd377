#pragma once

#include "core/numerics/model/level_model.h"

namespace drape {

/// x (n×3) [m] with the corners of triangles beyond a strain limit moved until all triangles are within it,
/// or as far as a few sweeps lead. Interpolation between levels that do not refine each other shortens some
/// edges across folds, and so stretches triangles. What the moves meet, or pass through, is not tested.
Positions within_limits(const LevelModel& model, Positions x);

}  // namespace drape
