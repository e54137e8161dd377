#pragma once

#include <memory>

#include "core/kernel/interfaces/energy.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {

/// Binds a formula to all hinges of the level. Throws std::runtime_error naming a hinge whose triangles have
/// no area.
std::unique_ptr<BoundEnergy> bind_hinges(const Law& law, const Level& level, const Material& material);

}  // namespace drape::formula
