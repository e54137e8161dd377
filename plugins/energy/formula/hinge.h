#pragma once

#include <memory>
#include <optional>

#include "core/kernel/interfaces/energy.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {

/// Binds a formula to all hinges of the level. Throws std::runtime_error naming a hinge whose triangles have
/// no area.
std::unique_ptr<BoundEnergy> bind_hinges(const Law& law, const Level& level, const Material& material);

/// Energy::midpoint_factor of a hinge's formula; none if no factor holds for all angles.
std::optional<double> hinge_midpoint_factor(const Law& law, const Material& material);

/// Energy::plate_stiffness of a hinge's formula, on a grid of right-angled triangles of 1 cm.
double hinge_plate_stiffness(const Law& law, const Material& material);

}  // namespace drape::formula
