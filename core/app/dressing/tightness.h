#pragma once

#include <string>

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/interfaces/level.h"

namespace drape {

/// Why a garment at x is too tight for its body: its tightest piece is stretched beyond what is allowed from
/// its rest shape on this level; `when` says when that was measured. Empty for one that is not.
std::string too_tight(const ClothParameters& cloth, const Level& level, const Positions& x, double allowed,
                      const std::string& when);

}  // namespace drape
