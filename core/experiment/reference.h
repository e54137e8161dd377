#pragma once

#include <optional>

#include "core/experiment/experiment.h"

namespace drape {

/// The state of the file that the experiment's `reference` names: a mesh, or the reference.ply of a run's
/// folder. Nothing without such a file; one that does not fit the finest level is appended to `errors`.
std::optional<Positions> read_reference(const Experiment& experiment, const Hierarchy& hierarchy,
                                        ConfigErrors& errors);

/// Goes on from a state of the finest level, by the experiment's common Newton, to the force tolerance of the
/// experiment's `reference`.
LevelResult solve_to_tolerance(const Experiment& experiment, const Scene& scene, const Positions& x,
                               Observer& observer);

}  // namespace drape
