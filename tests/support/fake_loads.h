#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/load_stepping.h"

/// Increments that change nothing and are applied as far as a test says.
class FakeLoads : public drape::LoadStepping {
 public:
  int increments = 3;
  double allowed = 1;                            ///< by advance()
  const drape::LevelModel* unchanged = nullptr;  ///< the model under every load
  std::vector<double> fractions;                 ///< that advance_by() applied
  drape::Positions last;                         ///< the cloth that was last asked about

  int increment_count() const override { return increments; }
  bool equilibrates() const override { return true; }
  void begin(int, bool) override {}
  drape::LoadSteppingState state() const override { return {increment_, {applied_}}; }
  void restore(int, const drape::LoadSteppingState&) override {}
  std::shared_ptr<const drape::LevelModel> model(int) override {
    return {std::shared_ptr<void>(), unchanged};
  }
  int increment() const override { return increment_; }
  bool complete() const override { return applied_ == 1; }
  double time() const override { return 10.0 * increment_; }
  drape::StepLimit advance(int, const drape::Positions& x) override {
    if (complete()) {
      ++increment_;
      applied_ = 0;
    }
    last = x;
    apply(allowed);
    return {allowed, allowed < 1 ? "the post" : ""};
  }
  bool advance_by(double fraction, int, const drape::Positions& x) override {
    last = x;
    fractions.push_back(fraction);
    apply(fraction);
    return true;
  }

 private:
  void apply(double fraction) { applied_ = fraction == 1 ? 1 : applied_ + fraction * (1 - applied_); }
  int increment_ = 0;
  double applied_ = 1;
};
