#pragma once

#include "core/kernel/model/refiner.h"

namespace drape {

/// 1→4 split: edge e gets vertex n_c + e. Triangle t becomes 4t + k at its corner k, for k = 0, 1, 2, and the
/// central triangle 4t + 3; all keep t's orientation.
Triangles split_triangles(const Level& coarse);

/// Midpoint refinement U_{l→l+1}: old vertices stay and new ones are edge midpoints, so the surface does not
/// move.
Refinement midpoint_refinement(const Level& coarse);

}  // namespace drape
