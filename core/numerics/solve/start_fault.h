#pragma once

#include <string>

#include "core/numerics/model/objective.h"

namespace drape {

/// Names what of the objective is not finite at the start x (n×3), and a remedy. `gradient` is ∇F(x).
std::string fault_at_start(const Objective& objective, const Positions& x, const Positions& gradient);

}  // namespace drape
