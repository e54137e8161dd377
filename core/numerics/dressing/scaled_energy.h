#pragma once

#include <memory>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// The energy times a factor ≥ 0, with the same stencils on every level.
std::shared_ptr<const Energy> scaled(std::shared_ptr<const Energy> energy, double factor);

}  // namespace drape
