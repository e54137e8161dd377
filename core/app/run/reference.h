#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// Continues from a state of the finest level to the force tolerance of the experiment's `reference`, with
/// the experiment's common Newton parameters.
LevelResult solve_to_tolerance(const Experiment& experiment, const Scene& scene, const Positions& x,
                               Observer& observer);

}  // namespace drape
