#pragma once

#include <memory>

#include "core/kernel/interfaces/energy.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {

/// Binds a formula to all vertices of the level. One that is linear in the position gives a LinearEnergy.
std::unique_ptr<BoundEnergy> bind_vertices(const Law& law, const Level& level, const Material& material);

}  // namespace drape::formula
