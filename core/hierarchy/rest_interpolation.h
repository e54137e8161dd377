#pragma once

#include "core/model/refiner.h"

namespace drape {

/// Linear interpolation over the coarse rest shape (n_f × n_c, rows sum to 1): each fine vertex follows the
/// coarse triangle that its rest position lies in, or nearest to it, so that a state keeps its strains when
/// it is carried up. `fine_rest` (n_f × 3, in m) is in the order of Refinement. Where a fine vertex rests at
/// its parent, or in the middle of its parent edge, its row is that of midpoint_refinement.
ProlongationMatrix rest_interpolation(const Level& coarse, const Positions& fine_rest);

}  // namespace drape
