#pragma once

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/plugin/make.h"

namespace drape {

/// Everything that one contact model is made from: its own section of an experiment's `contact`, and what it
/// takes of `obstacles` and `friction`.
///
/// An experiment describes its obstacles once, in one list, and friction once. Contact models declare what
/// they take of it (Parameter::from_experiment): `friction` goes to every model that declares it, an obstacle
/// to the first model that knows one of its keys (Parameter::identifies_item), such as `shape` or `mesh`. A
/// plugin sees a single struct of parameters and no experiment.
struct ContactConfig {
  PluginParameters parameters;
  std::vector<std::size_t> obstacles;  ///< its obstacles' indices in the experiment's list, ascending
};

/// Reads them, one for each contact model, in order. `models` receives the models' own sections and
/// `obstacles`, in the experiment's order, the obstacles, both with every parameter. Appends an error for an
/// obstacle that no model takes, naming a registered one that would, for friction that none of them has, and
/// for `obstacles` and `friction` in a model's own section.
std::vector<ContactConfig> contact_configs(const Registry& registry, const ExperimentParameters& parameters,
                                           ConfigErrors& errors, std::vector<ConfigNode>& models,
                                           std::vector<ConfigNode>& obstacles);

/// Why friction is refused where no contact model has any, with a remedy.
std::string refusal_of_friction(const Registry& registry);

/// The location of a model's refused parameter, in its own section or in one of its obstacles. Refers to all
/// arguments.
LocateFault locate_in_contact(const ContactConfig& config, const ConfigNode& section,
                              const std::vector<ConfigNode>& obstacles);

}  // namespace drape
