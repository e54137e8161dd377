#pragma once

#include "core/kernel/interfaces/refiner.h"

namespace drape {

/// Midpoint refinement U_{l→l+1}: old vertices stay and new ones are edge midpoints, so the surface does not
/// move.
Refinement midpoint_refinement(const Level& coarse);

}  // namespace drape
