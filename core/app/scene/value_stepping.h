#pragma once

#include <memory>
#include <vector>

#include "core/app/scene/load_state.h"

namespace drape {

/// Load stepping by values: each increment leads from some values to others, each load is made for values on
/// the way, and an increment that the cloth does not allow at once is applied in part, by a fraction of what
/// remains of each value. Has the load and the model of each level, whose model is made when it is asked for.
class ValueStepping : public LoadStepping {
 public:
  LoadSteppingState state() const override { return {increment_, load_->values}; }
  int increment() const final { return increment_; }
  bool complete() const final { return load_->values == values(increment_); }

  void begin(int level, bool from_start) final;
  void restore(int level, const LoadSteppingState& state) override;
  std::shared_ptr<const LevelModel> model(int level) final;

  StepLimit advance(int level, const Positions& x) override;
  bool advance_by(double fraction, int level, const Positions& x) final {
    return try_fraction(fraction, level, x).fraction == 1;
  }

 protected:
  /// Refers to the scene, whose own models have the load `first`.
  ValueStepping(const Scene& scene, std::shared_ptr<const LoadState> first);

  /// The values at the end of an increment.
  virtual std::vector<double> values(int increment) const = 0;
  /// The load with these values, which shares with `before` what is equal. Throws std::runtime_error with the
  /// fault if a parameter refuses its value.
  virtual std::shared_ptr<const LoadState> load_at(std::vector<double> values,
                                                   const LoadState& before) const = 0;
  /// What becomes of the load `next`, which follows the current one, if it begins with the cloth at x on this
  /// level.
  virtual std::shared_ptr<const LoadState> begun_at(std::shared_ptr<const LoadState> next,
                                                    [[maybe_unused]] int level,
                                                    [[maybe_unused]] const Positions& x) const {
    return next;
  }

  const Scene& scene() const { return scene_; }
  const LoadState& load() const { return *load_; }
  /// Returns to an increment, and gives this level and all finer ones a load of it.
  void set(int level, int increment, std::shared_ptr<const LoadState> load);

 private:
  /// A level's load, and its model, which was made for the load `made_of`.
  struct LoadedLevel {
    std::shared_ptr<const LoadState> load, made_of;
    std::shared_ptr<const LevelModel> model;
  };

  std::shared_ptr<const LoadState> next_load(std::vector<double> values) const;
  StepLimit try_fraction(double fraction, int level, const Positions& x);

  const Scene& scene_;
  int increment_ = 0;
  std::shared_ptr<const LoadState> load_;
  std::vector<LoadedLevel> levels_;
};

}  // namespace drape
