#pragma once

#include "core/kernel/interfaces/level.h"

namespace drape {

/// How far the garment that has sunk farthest is below where it was [m], 0 if none has sunk. A garment is a
/// connected part of the level, its height that of the mean of its area, and up is against the sum of its
/// `loads` (forces, n×3) [N]; one whose loads have no sum neither sinks nor rises.
double sinking(const Level& level, const Positions& loads, const Positions& from, const Positions& to);

}  // namespace drape
