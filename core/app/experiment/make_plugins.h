#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// Makes the energies, refiner, contact models, metrics and solvers of an experiment, whose parameters and
/// source are read, and adds all their parameters to `resolved`. Without `metrics` it makes all that are
/// registered. Appends every error.
void make_plugins(const Registry& registry, ConfigErrors& errors, Experiment& experiment);

}  // namespace drape
