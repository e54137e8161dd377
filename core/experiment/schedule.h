#pragma once

#include "core/experiment/experiment.h"

namespace drape {

/// Sets the first value of every key of the schedule in an experiment's map, before the map is read.
/// check_schedule reports faults of the keys.
void set_first_keys(ConfigNode& source);

/// Appends the faults of a schedule: parameters that may not change, times that do not ascend, and values
/// that their parameters refuse.
void check_schedule(const Experiment& experiment, ConfigErrors& errors);

/// The loads and models' parts at one pseudo-time.
struct Moment {
  ExperimentParameters parameters;
  std::vector<NamedEnergy> energies;  ///< handles among them
  std::vector<std::shared_ptr<ContactModel>> contacts;
};

/// The keyed parameters of an experiment over pseudo-time, and a scene's models under them. Refers to the
/// scene, which owns it.
class Schedule final : public Conditions {
 public:
  Schedule(Experiment experiment, Scene& scene);

  int changes() const override { return p_.steps; }
  bool settles() const override { return p_.equilibrate; }
  void begin(int level, bool from_start) override;
  ConditionsState state() const override { return {change_, effective_}; }
  void restore(int level, const ConditionsState& state) override;
  int change() const override { return change_; }
  bool made() const override { return effective_ == wanted(change_); }
  double time() const override { return duration_ * change_ / p_.steps; }
  StepLimit advance(int level, const Positions& x) override;
  bool advance_by(double part, int level, const Positions& x) override;

 private:
  std::vector<double> wanted(int change) const;
  /// For the concatenated values of all keys. Unchanged objects are shared with now_.
  Moment moment(const std::vector<double>& numbers, std::vector<std::string>& made_from) const;
  LevelModel model_under(const Moment& moment, int level) const;
  /// Applies a fraction of the rest of the increment if a cloth at x admits it: 1 if so, otherwise the part
  /// of the fraction that may be admissible.
  StepLimit make_part(double part, int level, const Positions& x);
  /// Updates energies on finer levels, which a method may evaluate; contact there has no state yet.
  void change_energies_above(int level, const Moment& next);
  void go_to(Moment moment, std::vector<std::string> made_from, std::vector<double> numbers);
  void bind_from(int level);

  const Experiment experiment_;
  Scene& scene_;
  const ScheduleParameters& p_;                           // experiment_'s
  std::vector<std::vector<std::vector<double>>> values_;  // of each key at each of its times
  double duration_;
  int change_ = 0;
  std::vector<double> effective_;
  Moment now_;                          // of effective_
  std::vector<std::string> made_from_;  // texts of the nodes that now_'s plugins were made from
};

}  // namespace drape
