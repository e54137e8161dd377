#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/app/experiment/experiment.h"

namespace drape {

/// What the models of all levels are made from under one load. Shares with other loads what is equal.
struct Load {
  std::vector<double> values;                              ///< that the load was made for
  std::shared_ptr<const ExperimentParameters> parameters;  ///< for material, pins and handles
  std::vector<NamedEnergy> energies;                       ///< handles last, if a scene has made them
  std::vector<std::shared_ptr<ContactModel>> contacts;
};

/// A parameter of the experiment with its value under a load.
struct LoadValue {
  std::string path;      ///< as for --set
  std::string section;   ///< of the experiment: the path's first word
  std::size_t item = 0;  ///< of that section, if it is a list
  ConfigNode value;
  bool changes = false;  ///< the load before has another value
};

/// The values of all keys of a schedule, which has them one after another, where a load before had the
/// others.
std::vector<LoadValue> load_values(const std::vector<ScheduleKey>& keys, std::span<const double> values,
                                   std::span<const double> before);

/// Makes again what differs from `load` with these values: what the experiment's source gives with the values
/// in it. Appends an error for every value that is refused.
void set_values(const Experiment& experiment, const std::vector<LoadValue>& values, Load& load,
                ConfigErrors& errors);

}  // namespace drape
