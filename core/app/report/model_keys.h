#pragma once

#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"

namespace drape {

/// The paths of the keys in which two experiments differ, among those that say whose energy is minimised:
/// cloth, levels, material, boundary conditions, schedule, energies, refiner, contact, obstacles and
/// friction, and neither start nor methods. A key that one of them lacks is no difference.
std::vector<std::string> differing_model_keys(const ConfigNode& a, const ConfigNode& b);

/// The values of these keys as one text, which two experiments share if they minimise the same energy.
std::string model_of(const ConfigNode& config);

}  // namespace drape
