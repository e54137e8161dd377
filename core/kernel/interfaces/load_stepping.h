#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/energy.h"

namespace drape {

class LevelModel;

/// How far load stepping has come.
struct LoadSteppingState {
  int increment = 0;
  std::vector<double> values;        ///< that the load was made for
  std::vector<Positions> kept = {};  ///< states of the cloth on which this or a later load depends, n×3 [m]
};

/// Incremental loading: boundary conditions, obstacles, material and loads follow a pseudo-time while a level
/// is solved (docs/guide/schedules.md). The increments are 0 … increment_count(). An increment that the
/// cloth does not allow at once, such as an obstacle that would hit it, is applied in part and continued
/// later. Models are values: every load that is reached has its own.
class LoadStepping {
 public:
  virtual ~LoadStepping() = default;

  virtual int increment_count() const = 0;
  /// True if every increment is solved to equilibrium, false if each gets one implicit step. The last one is
  /// always solved to equilibrium.
  virtual bool equilibrates() const = 0;

  /// Begins a level. Returns to increment 0 if the level starts from the scene's start; otherwise continues
  /// from the load that the previous level reached.
  virtual void begin(int level, bool from_start) = 0;

  virtual LoadSteppingState state() const = 0;
  /// Begins a level with the load of an earlier state.
  virtual void restore(int level, const LoadSteppingState& state) = 0;

  /// The plain model of a level under the current load; coarser levels than the begun one keep theirs.
  virtual std::shared_ptr<const LevelModel> model(int level) = 0;

  /// The current increment, and whether it has been applied in full.
  virtual int increment() const = 0;
  virtual bool complete() const = 0;
  bool finished() const { return increment() == increment_count() && complete(); }
  /// Pseudo-time of the current increment, in the schedule's unit.
  virtual double time() const = 0;
  /// The name of the phase that the current increment belongs to; empty for a schedule without phases.
  virtual std::string phase() const { return ""; }
  /// Whether the current increment is the last one of its phase.
  virtual bool ends_phase() const { return false; }
  /// How many times the force tolerance is enough for an equilibrium of the current increment [1].
  virtual double slack() const { return 1; }

  /// Once an increment has been solved to x (n×3) [m] on this level: where the cloth was under an earlier
  /// load, to which load stepping has gone back; null to go on.
  virtual const Positions* step_back([[maybe_unused]] int level, [[maybe_unused]] const Positions& x) {
    return nullptr;
  }
  /// Continues the current increment, or begins the next, as far as a cloth at x (n×3) [m] allows on this
  /// level. Returns the fraction of the remaining increment that was applied.
  virtual StepLimit advance(int level, const Positions& x) = 0;
  /// Applies this fraction of the remaining increment if a cloth at x allows all of it, else returns false.
  virtual bool advance_by(double fraction, int level, const Positions& x) = 0;
};

/// Result of one increment on one level, for observers.
struct IncrementRow {
  int level = 0, increment = 0;
  double time = 0;                      ///< pseudo-time
  int steps = 0, iterations = 0;        ///< of this increment
  double energy = 0;                    ///< of the objective, without friction [J]
  double force_residual = 0;            ///< [1]
  double max_constraint_violation = 0;  ///< largest distance of a Dirichlet vertex from its target [m]
};

}  // namespace drape
