#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"

namespace drape {

/// Names of the fabrics that come with drape, in its order.
std::vector<std::string> fabric_names();
/// Names of the fabrics in a CSV file's rows; a row without one has its number. Throws std::runtime_error if
/// it cannot be read.
std::vector<std::string> fabric_names(const std::filesystem::path& file);

/// A fabric's values for keys of `material`, and its `source`: of NAME in the table that comes with drape, or
/// of {file, row}, a CSV file whose cells commas, semicolons or tabs separate, with columns like that table's
/// or ClothDrapeTester's, in letters of either case. At another `thickness` [m] than the fabric's, mass per
/// area, tensile stiffness and bending rigidity are the same. Appends errors with their place: an unknown
/// name, with the nearest one, a missing file, row or column, a name that several rows or columns have, a
/// cell that is not a number.
ConfigNode fabric_row(const ConfigNode& fabric, std::optional<double> thickness, ConfigErrors& errors);

/// Replaces `material.fabric` of an experiment by its values for the keys that `material` does not have,
/// without those that could not stand beside what it has, and by its name as `material.from_fabric`.
void apply_fabric(ConfigNode& experiment, ConfigErrors& errors);

}  // namespace drape
