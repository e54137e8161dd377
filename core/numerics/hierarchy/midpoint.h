#pragma once

#include "core/kernel/interfaces/refiner.h"

namespace drape {

/// U_{l→l+1}: old vertices stay and new ones are edge midpoints, so the surface does not move.
ProlongationMatrix midpoint_weights(const Level& coarse);

/// The rest shape of the next level by a refiner's weights: triangle t becomes 4t … 4t + 3.
TriangleMesh refined_rest(const Level& coarse, const ProlongationMatrix& weights);

}  // namespace drape
