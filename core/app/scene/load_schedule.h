#pragma once

#include "core/app/scene/scene.h"
#include "core/kernel/plugin/make.h"

namespace drape {

/// What the models of all levels are made from under one load. Immutable; shares with other loads what is
/// equal.
struct LoadState {
  std::vector<double> values;                              ///< of all keys, one after another
  std::shared_ptr<const ExperimentParameters> parameters;  ///< for material, pins and handles
  std::vector<NamedEnergy> energies;                       ///< handles last
  std::vector<std::shared_ptr<ContactModel>> contacts;
};

/// The loads of a scene, with its levels and models, as a function of its keyed parameters. Immutable; refers
/// to the scene, which must outlive it.
class LoadSchedule {
 public:
  LoadSchedule(const Experiment& experiment, const Scene& scene);

  /// The keys and their times.
  const ScheduleParameters& keys() const { return first_->parameters->schedule; }
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
  /// All that the keys change of one plugin, or of the experiment's own sections.
  struct Change {
    LoadPart part;
    std::size_t item;
    PluginParameters first;  // under the first load; without an entry for the experiment's own
    std::vector<std::pair<DeclaredNumbers, std::size_t>> numbers;  // with the index of their first value
  };
  Change& change_of(const Experiment& experiment, const KeyTarget& target);

  const Hierarchy& hierarchy_;
  const std::vector<Positions>& placed_;
  const std::vector<FollowingVertices>& following_;
  std::vector<Change> changes_;
  std::shared_ptr<const LoadState> first_;
};

/// Load stepping along a scene's schedule: how far it has come, and the load and model of each level. A
/// level's model is made when it is asked for. Refers to the scene, which owns it.
class ScheduleStepping final : public LoadStepping {
 public:
  ScheduleStepping(LoadSchedule schedule, const Scene& scene);

  int increment_count() const override { return schedule_.keys().steps; }
  bool equilibrates() const override { return schedule_.keys().equilibrate; }
  void begin(int level, bool from_start) override;
  LoadSteppingState state() const override { return {increment_, load_->values}; }
  void restore(int level, const LoadSteppingState& state) override;
  std::shared_ptr<const LevelModel> model(int level) override;
  int increment() const override { return increment_; }
  bool complete() const override { return load_->values == schedule_.values(increment_); }
  double time() const override { return schedule_.keys().time(increment_); }
  StepLimit advance(int level, const Positions& x) override;
  bool advance_by(double fraction, int level, const Positions& x) override;

 private:
  /// A level's load, and its model, which was made for the load `made_of`.
  struct LoadedLevel {
    std::shared_ptr<const LoadState> load, made_of;
    std::shared_ptr<const LevelModel> model;
  };

  /// The load with these values of all keys. Throws std::runtime_error naming the pseudo-time and the fault.
  std::shared_ptr<const LoadState> load_at(std::vector<double> values) const;
  /// Applies a fraction of the remaining increment if a cloth at x allows it. Returns 1 if so, else an
  /// estimate of the feasible part of that fraction.
  StepLimit try_fraction(double fraction, int level, const Positions& x);
  /// Gives this level and all finer ones a load.
  void set_load(int level, std::shared_ptr<const LoadState> load);

  const LoadSchedule schedule_;
  int increment_ = 0;
  std::shared_ptr<const LoadState> load_;
  std::vector<LoadedLevel> levels_;
};

/// Appends an error, with the key's location, for every key of the schedule at one of whose times a pin or
/// handle selects no vertex of a level, or an energy cannot be bound or has other stencils than at the start.
void check_schedule_on_levels(const Experiment& experiment, const Scene& scene, const LoadSchedule& schedule,
                              ConfigErrors& errors);

}  // namespace drape
