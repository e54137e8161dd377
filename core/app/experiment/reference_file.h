#pragma once

#include <optional>

#include "core/app/experiment/experiment.h"

namespace drape {

/// The state in the file that the experiment's `reference` names: a mesh, or the reference.ply of a run's
/// folder. Empty without such a file, and, with an error appended, if it does not fit the finest level.
std::optional<Positions> read_reference(const Experiment& experiment, const Hierarchy& hierarchy,
                                        ConfigErrors& errors);

}  // namespace drape
