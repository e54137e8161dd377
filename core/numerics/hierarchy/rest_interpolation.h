#pragma once

#include "core/kernel/interfaces/refiner.h"

namespace drape {

/// Linear interpolation over the coarse rest shape (n_f × n_c, rows sum to 1).
///
/// Each fine vertex follows the coarse triangle that contains its rest position, or the nearest one. A
/// prolonged state therefore keeps its strains. `fine_rest` (n_f × 3) [m] is in the order of split_triangles.
/// A fine vertex that rests at its parent, or at the midpoint of its parent edge, gets its row of
/// midpoint_weights.
ProlongationMatrix rest_interpolation(const Level& coarse, const Positions& fine_rest);

}  // namespace drape
