#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// Appends an error, with the key's location, for every key of the schedule at one of whose times a pin or
/// handle selects no vertex of a level, or an energy cannot be bound or has other stencils than at the start.
/// The schedule must have passed check_schedule, and the scene needs its levels and models.
void check_schedule_on_levels(const Experiment& experiment, const Scene& scene, ConfigErrors& errors);

}  // namespace drape
