#pragma once

#include <string>

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/interfaces/level.h"

namespace drape {

/// A message that begins with the place of a panel in its pattern, and with `verdict`, and names the tightest
/// piece of a garment at x (n×3) [m], if more than a tenth of its area is stretched from its rest shape on
/// this level by more than `much` [1]; else empty.
std::string tightness_text(const std::string& verdict, const ClothParameters& cloth, const Level& level,
                           const Positions& x, double much);

}  // namespace drape
