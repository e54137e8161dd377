#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// Sets the first value of every key of the schedule in an experiment's map, before the map is read.
/// check_schedule reports faults of the keys.
void set_first_keys(ConfigNode& source);

/// Appends the faults of a schedule: parameters that may not change, times that do not ascend, and values
/// that their parameters refuse.
void check_schedule(const Experiment& experiment, ConfigErrors& errors);

/// A key's path in an experiment's map, with indices in place of names: paths of one parameter are equal.
std::vector<std::string> indexed_path(const ConfigNode& config, const std::string& path);

/// The values of all keys of a schedule over pseudo-time, one after another.
class KeyedValues {
 public:
  explicit KeyedValues(const ScheduleParameters& schedule);

  /// The pseudo-time at the end of an increment, in the keys' unit.
  double time(int increment) const { return duration_ * increment / steps_; }
  std::vector<double> at(double time) const;
  /// Those of set_first_keys.
  std::vector<double> first() const;
  /// The number of values of key k.
  std::size_t count(std::size_t k) const { return values_[k][0].size(); }
  /// The values of key k from `values` on, as its parameter is written: a number or a list.
  ConfigNode node(std::size_t k, const double* values) const;

 private:
  std::vector<KeyParameters> keys_;
  std::vector<std::vector<std::vector<double>>> values_;  // of each key at each of its times
  double duration_ = 0;
  int steps_ = 1;
};

}  // namespace drape
