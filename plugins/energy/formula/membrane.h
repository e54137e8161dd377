#pragma once

#include <memory>

#include "core/kernel/interfaces/energy.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {

/// Binds a formula to all triangles of the level. Throws std::runtime_error naming a triangle without area.
std::unique_ptr<BoundEnergy> bind_membrane(const Law& law, const Level& level, const Material& material);

/// Binds a formula to a level on which the cloth buckles below the mesh: as bind_buckling_membrane does if it
/// depends on principal stretches alone, else as bind_buckling_strains does. A formula of both principal
/// stretches and strains keeps its plain energy.
std::unique_ptr<BoundEnergy> bind_buckling(const Law& law, const Level& level, const Material& material,
                                           double s);

}  // namespace drape::formula
