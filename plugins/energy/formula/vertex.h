#pragma once

#include <memory>
#include <optional>

#include "core/kernel/interfaces/energy.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {

/// Binds a formula to all vertices of the level. One that is linear in the position gives a LinearEnergy.
std::unique_ptr<BoundEnergy> bind_vertices(const Law& law, const Level& level, const Material& material);

/// Energy::midpoint_factor of a vertex's formula: 1 for forces in proportion to area or mass, else none.
std::optional<double> vertex_midpoint_factor(const Law& law, const Material& material);

}  // namespace drape::formula
