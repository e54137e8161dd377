#pragma once

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

/// Everything that one contact model is made from, put together from an experiment's `contact`, `obstacles`
/// and `friction`.
///
/// An experiment describes its obstacles once, in one list, and friction once. Contact models declare what
/// they take of it (Parameter::from_experiment): `friction` goes to every model that declares it, an obstacle
/// to the first model that knows one of its keys (Parameter::identifies_item), such as `shape` or `mesh`. A
/// plugin sees a single struct of parameters and no experiment.
struct ContactConfig {
  ConfigNode node;                     ///< with all its parameters, for read_plugin_parameters
  std::vector<std::size_t> obstacles;  ///< its obstacles' indices in the experiment's list, ascending
};

/// One for each contact model, in order. Appends an error for an obstacle that none of them takes, naming a
/// registered model that would, for friction that none of them has, and for `obstacles` and `friction` in a
/// model's own section.
std::vector<ContactConfig> contact_configs(const Registry& registry, const ExperimentParameters& parameters,
                                           ConfigErrors& errors);

/// Indices in the experiment's list of all models' obstacles, in the order of obstacles_of.
std::vector<std::size_t> obstacle_order(const Registry& registry, const ExperimentParameters& parameters);

/// Their names, empty for an obstacle without one.
std::vector<std::string> obstacle_names(const Registry& registry, const ExperimentParameters& parameters);

/// Splits a model's resolved node: moves its obstacles to their indices in `obstacles`, and removes what
/// stands at the top of the experiment.
void split_resolved(const Registry& registry, const ContactConfig& config, ConfigNode& resolved,
                    std::vector<ConfigNode>& obstacles);

}  // namespace drape
