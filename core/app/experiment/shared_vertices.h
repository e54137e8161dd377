#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// Appends an error for every two pins, and every two handles, that select the same vertex of a level and
/// have different targets for it. `placed` has the positions, n×3 [m] for each level, where those without a
/// transform hold.
void check_shared_vertices(const Experiment& experiment, const std::vector<Level>& levels,
                           const std::vector<Positions>& placed, ConfigErrors& errors);

/// The same under a load with these parameters, for pin or handle k and all others. The errors have `where`
/// as location.
void check_shared_vertices(const ExperimentParameters& parameters, LoadPart part, std::size_t k,
                           const Location& where, const std::vector<Level>& levels,
                           const std::vector<Positions>& placed, ConfigErrors& errors);

}  // namespace drape
