#pragma once

#include <memory>
#include <vector>

#include "core/app/scene/load_state.h"

namespace drape {

/// The loads of a scene as a function of its keyed parameters. Immutable; has a copy of the experiment, and
/// refers to the scene, which must outlive it.
class LoadSchedule {
 public:
  LoadSchedule(const Experiment& experiment, const Scene& scene);

  /// The keys and their times.
  const ScheduleParameters& keys() const { return experiment_.parameters.schedule; }
  /// The values of all keys at the end of an increment.
  std::vector<double> values(int increment) const { return keys().values_at(keys().time(increment)); }

  /// The load of the scene's own models.
  const std::shared_ptr<const LoadState>& first() const { return first_; }
  /// The load with these values, which shares with `before` what is equal. Throws std::runtime_error with the
  /// fault if a parameter refuses its value.
  std::shared_ptr<const LoadState> at(std::vector<double> values, const LoadState& before) const;
  std::shared_ptr<const LoadState> at(std::vector<double> values) const {
    return at(std::move(values), *first_);
  }

 private:
  const Experiment experiment_;
  const Scene& scene_;
  std::shared_ptr<const LoadState> first_;
};

/// Load stepping along the schedule of an experiment with keys; refers to the scene, which owns it. Null,
/// with an error at the key's location appended, for every key at one of whose times a pin or handle selects
/// no vertex of a level, or an energy cannot be bound or has other stencils than at the start.
std::unique_ptr<LoadStepping> load_stepping_of(const Experiment& experiment, const Scene& scene,
                                               ConfigErrors& errors);

}  // namespace drape
