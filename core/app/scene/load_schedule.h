#pragma once

#include <memory>
#include <vector>

#include "core/app/scene/scene.h"
#include "core/kernel/threads/deferred.h"

namespace drape {

/// A load of a scene. Immutable.
struct LoadState : Load {
  /// By level, rests of membranes between the shape that pieces were placed in and their own, if any.
  std::vector<Deferred<Level>> rests;
  /// Where pins hold a garment that has been sewn: its positions then, prolonged to the finest level from the
  /// one that it was sewn on, n×3 [m]; null: where the scene placed it.
  std::shared_ptr<const Positions> sewn;
};

/// The loads of a scene, with its levels and models, as a function of its keyed parameters. Immutable; has a
/// copy of the experiment, and refers to the scene, which must outlive it.
class LoadSchedule {
 public:
  LoadSchedule(const Experiment& experiment, const Scene& scene);

  /// The keys and their times.
  const ScheduleParameters& keys() const { return keys_; }
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

  /// The plain model of a level under a load, which shares with `before`, a model of the same level under
  /// another load, what is equal.
  std::shared_ptr<const LevelModel> model(const LoadState& load, int level, const LevelModel& before) const;

 private:
  void dress(LoadState& load, const LoadState& before) const;
  /// Where pins without a transform hold, n×3 [m]: where the garment was sewn, else where the scene placed
  /// it.
  Positions placed(const LoadState& load, int level) const;

  const Experiment experiment_;
  const Scene& scene_;
  const ScheduleParameters keys_;
  std::shared_ptr<const LoadState> first_;
};

/// The positions of a coarser level's vertices, which are among those of a finer level (x, n×3).
Positions own_of(const Hierarchy& hierarchy, const Positions& x, int fine, int coarse);

/// Load stepping along the schedule of an experiment with keys; refers to the scene, which owns it. Null,
/// with an error at the key's location appended, for every key at one of whose times a pin or handle selects
/// no vertex of a level, or an energy cannot be bound or has other stencils than at the start.
std::unique_ptr<LoadStepping> load_stepping_of(const Experiment& experiment, const Scene& scene,
                                               ConfigErrors& errors);

}  // namespace drape
