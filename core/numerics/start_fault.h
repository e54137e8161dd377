#pragma once

#include <string>

#include "core/model/objective.h"

namespace drape {

/// What of the objective is not finite at the start x, and what to do; `gradient` is its gradient there.
std::string fault_at_start(const Objective& objective, const Positions& x, const Positions& gradient);

}  // namespace drape
