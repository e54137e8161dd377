#pragma once

#include "core/app/dressing/friction.h"
#include "core/app/dressing/phase.h"

namespace drape {

/// The loads of a dressing as a function of values, those of its phases one after another, then those of its
/// frictions. Immutable; has a copy of the experiment, and refers to the scene, which must outlive it.
class DressingLoads {
 public:
  DressingLoads(const Experiment& experiment, const Scene& scene, DressingStart start);
  DressingLoads(const DressingLoads&) = delete;
  DressingLoads& operator=(const DressingLoads&) = delete;

  bool has_pins() const { return !experiment_.parameters.pins.empty(); }

  int increment_count() const { return count_; }
  /// The values at the end of an increment. A garment that is `held` has friction while it is sewn.
  std::vector<double> values(int increment, bool held) const;
  /// Whether a garment may be held while it is sewn: the experiment has friction, and `dress` has none.
  bool can_hold() const;
  /// Whether one of the frictions acts in a load with these values.
  bool has_friction(const std::vector<double>& values) const;
  /// The forces of all loads on a level at x (n×3), without handles [N].
  Positions forces(const Level& level, const Positions& x) const;
  /// The load of the scene's own models, those of a garment that is worn.
  const std::shared_ptr<const LoadState>& worn() const { return worn_; }
  /// The load with these values, which shares with `before` what is equal. Throws std::runtime_error with the
  /// fault if a parameter refuses its value.
  std::shared_ptr<const LoadState> at(std::vector<double> values, const LoadState& before) const;

  /// The phase that an increment from 1 on belongs to, and which of the phase's increments it is.
  struct Place {
    const DressingPhase* phase;
    int increment;
  };
  Place place(int increment) const;
  /// The last increment of a phase.
  int end_of(const std::string& phase) const;

 private:
  /// A phase, and what its parameters are in an experiment.
  struct Part {
    std::unique_ptr<const DressingPhase> phase;
    std::vector<LoadValue> parameters;
    int begin = 0;          ///< increments of the phases before
    std::size_t count = 0;  ///< of its values
  };

  DressingFriction friction_at(int increment, bool held) const;

  const Experiment experiment_;
  const Frictions frictions_;
  std::vector<LoadValue> friction_parameters_;
  std::vector<Part> parts_;
  int count_ = 0;
  std::shared_ptr<const LoadState> worn_;
};

}  // namespace drape
