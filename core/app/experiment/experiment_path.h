#pragma once

#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"

namespace drape {

/// The words of a parameter's path in an experiment. The type of a plugin that is not in a list is left out:
/// "contact.shapes.dhat" is "contact.dhat" where the experiment has `contact: shapes`. A named constant is
/// found by its name: "energies.cloth.warp" is "energies.cloth.constants.warp.value" where it has a unit.
std::vector<std::string> words_of_path(const ConfigNode& experiment, const std::string& path);

/// The value at a parameter's path in a resolved experiment; null if there is none.
const ConfigNode* value_at(const ConfigNode& experiment, const std::string& path);

/// The unit of the number at a parameter's path; empty if it has none, or belongs to a plugin.
std::string unit_of(const std::string& path);

/// As set_path, for the parameters of an experiment: the type of a plugin may stand in the path whether it is
/// in a list or alone, the default refiner need not be written, and what is missing is named.
bool set_parameter(ConfigNode& experiment, const std::string& path, ConfigNode value, const Location& where,
                   ConfigErrors& errors);

/// Sets a YAML value from the command line; its locations are the option, as in "--set levels".
bool set_parameter(ConfigNode& experiment, const std::string& path, const std::string& value,
                   const std::string& option, ConfigErrors& errors);

/// Appends an error if a schedule of the experiment, whose first value replaces any other, sets the value at
/// this path.
void refuse_scheduled(const ConfigNode& experiment, const std::string& path, const std::string& option,
                      ConfigErrors& errors);

}  // namespace drape
