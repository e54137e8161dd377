#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

// The steps of read_experiment.

/// Sets the first value of every key of the schedule in an experiment's map, before the map is read.
/// read_keys reports faults of the keys.
void set_first_keys(ConfigNode& source);

/// The part of make_plugins that makes contact models. Appends an error for an obstacle that no model takes,
/// naming a registered one that would, for friction that none of them has, and for `obstacles` and `friction`
/// in a model's own section.
void make_contacts(Experiment& experiment, ConfigErrors& errors);

/// The section of contact model k as its schema has it, with the obstacles and the friction of an experiment
/// with these parameters.
ConfigNode contact_section(const Experiment& experiment, const ExperimentParameters& parameters,
                           std::size_t k, ConfigErrors& errors);

/// Makes the energies, refiner, contact models, metrics and solvers of an experiment, whose parameters and
/// source are read, and adds all their parameters to `resolved`. Without `metrics` it makes all that are
/// registered. Appends every error.
void make_plugins(Experiment& experiment, ConfigErrors& errors);

/// Finds the values of an experiment's keys, and the sections that they change; the plugins must have been
/// made. Appends the faults of the keys: parameters that may not change, times that do not ascend, and
/// values that their parameters refuse.
void read_keys(Experiment& experiment, ConfigErrors& errors);

}  // namespace drape
