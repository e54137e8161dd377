#pragma once

#include <string>
#include <vector>

#include "core/app/experiment/experiment.h"

namespace drape {

/// In place of a method's name: every method. No method can have this name.
inline constexpr const char* all_methods = "all";

/// The method that a command takes when the user names none: pcs, or else the only one; empty if neither
/// exists.
std::string default_method(const std::vector<std::string>& methods);

/// The methods that a run of the experiment executes, in the experiment's order: those that the user asks
/// for (`all_methods` is every one), or the default method. Throws std::runtime_error for an unknown method,
/// and if the user must choose.
std::vector<std::string> chosen_methods(const Experiment& experiment, const std::vector<std::string>& asked);

}  // namespace drape
