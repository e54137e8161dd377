#pragma once

#include "core/model/refiner.h"

namespace drape {

/// The 1→4 split: edge e gets vertex n_c + e. Triangle t gives 4t + k, which keeps its corner k, for
/// k = 0, 1, 2, and the middle one 4t + 3; all keep t's orientation.
Triangles split_triangles(const Level& coarse);

/// U_{l→l+1}: every old vertex stays and every new one is the midpoint of its edge, so that the surface
/// does not move.
Refinement midpoint_refinement(const Level& coarse);

}  // namespace drape
