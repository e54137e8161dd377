#pragma once

#include <string>
#include <vector>

namespace drape {

/// The paths of the keys in which two experiments differ, config.yaml's texts, among those that say whose
/// energy is minimised: cloth, levels, material, boundary conditions, schedule, energies, refiner, contact,
/// obstacles and friction, and neither start nor methods. A key that one of the texts lacks is no difference.
/// Empty if a text is no YAML.
std::vector<std::string> differing_model_keys(const std::string& a, const std::string& b);

/// The values of these keys as one text, which two experiments share if they minimise the same energy.
std::string model_of(const std::string& configuration);

}  // namespace drape
