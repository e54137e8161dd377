#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// Sets the first value of every key of the schedule in an experiment's map, before the map is read.
/// check_schedule reports faults of the keys.
void set_first_keys(ConfigNode& source);

/// Appends the faults of a schedule: parameters that may not change, times that do not ascend, and values
/// that their parameters refuse.
void check_schedule(const Experiment& experiment, ConfigErrors& errors);

/// The parameters, energies and contact models at one point of the pseudo-time.
struct LoadState {
  ExperimentParameters parameters;
  std::vector<NamedEnergy> energies;  ///< handles among them
  std::vector<std::shared_ptr<ContactModel>> contacts;
};

/// The keyed parameters of an experiment over pseudo-time, and a scene's models under them. Refers to the
/// scene, which owns it.
class Schedule final : public LoadStepping {
 public:
  Schedule(Experiment experiment, Scene& scene);

  int increment_count() const override { return p_.steps; }
  bool equilibrates() const override { return p_.equilibrate; }
  void begin(int level, bool from_start) override;
  LoadSteppingState state() const override { return {increment_, effective_}; }
  void restore(int level, const LoadSteppingState& state) override;
  int increment() const override { return increment_; }
  bool complete() const override { return effective_ == wanted(increment_); }
  double time() const override { return duration_ * increment_ / p_.steps; }
  StepLimit advance(int level, const Positions& x) override;
  bool advance_by(double fraction, int level, const Positions& x) override;

 private:
  std::vector<double> wanted(int increment) const;
  /// The state for the numbers of all keys, one after another. Shares with now_ all that is equal.
  LoadState load_state(const std::vector<double>& numbers, std::vector<std::string>& made_from) const;
  LevelModel model_for(const LoadState& state, int level) const;
  /// Applies a fraction of the remaining increment if a cloth at x allows it. Returns 1 if so, else an
  /// estimate of the feasible part of that fraction.
  StepLimit try_fraction(double fraction, int level, const Positions& x);
  /// Updates energies on finer levels, which a proxy may evaluate; their contacts are not in use yet.
  void update_energies_above(int level, const LoadState& next);
  void set_state(LoadState state, std::vector<std::string> made_from, std::vector<double> numbers);
  void bind_from(int level);

  const Experiment experiment_;
  Scene& scene_;
  const ScheduleParameters& p_;                           // experiment_'s
  std::vector<std::vector<std::vector<double>>> values_;  // of each key at each of its times
  double duration_;
  int increment_ = 0;
  std::vector<double> effective_;
  LoadState now_;                       // for effective_
  std::vector<std::string> made_from_;  // YAML of now_'s plugins
};

}  // namespace drape
