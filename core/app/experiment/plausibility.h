#pragma once

#include "core/app/experiment/experiment.h"
#include "core/app/experiment/scene_summary.h"

namespace drape {

/// A warning for every quantity of a scene that is outside any fabric's range, as after a mistake with a
/// unit: where it is set, what is usual, and what to do. None of them keeps an experiment from running.
ConfigErrors plausibility_warnings(const Experiment& experiment, const Scene& scene,
                                   const SceneSummary& summary);

/// Appends an error for every level at whose start an energy or a force is not finite.
void refuse_infinite_energies(const Experiment& experiment, const Scene& scene, ConfigErrors& errors);

}  // namespace drape
