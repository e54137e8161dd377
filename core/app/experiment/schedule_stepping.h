#pragma once

#include "core/app/experiment/load_schedule.h"

namespace drape {

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

}  // namespace drape
