#pragma once

#include <vector>

#include "core/hierarchy/level.h"
#include "core/model/energy.h"

namespace drape {

/// Which conditions have been reached.
struct ConditionsState {
  int change = 0;
  std::vector<double> numbers;  ///< of what is keyed
};

/// What changes in pseudo-time while a level is solved: places, obstacles, material, loads (docs/method.md,
/// section 8). A sequence of conditions 0 … changes(); the models of a problem are always under those that
/// were reached. A change that is not allowed at once, as an obstacle that meets the cloth, is made in part
/// and gone on with later.
class Conditions {
 public:
  virtual ~Conditions() = default;

  virtual int changes() const = 0;
  /// Whether every change is followed by equilibrium, or by one implicit step. After the last it always is.
  virtual bool settles() const = 0;

  /// Before a level is begun: its model, and the energies of finer ones, are put under the first conditions
  /// if it is begun from the scene's start, and otherwise under those that the last level reached.
  virtual void begin(int level, bool from_start) = 0;

  virtual ConditionsState state() const = 0;
  /// As `begin`, under conditions that were reached earlier.
  virtual void restore(int level, const ConditionsState& state) = 0;

  /// The change that is under way, or was made last, and whether it has been made in full.
  virtual int change() const = 0;
  virtual bool made() const = 0;
  bool finished() const { return change() == changes() && made(); }
  /// The pseudo-time of that change, in the schedule's unit.
  virtual double time() const = 0;

  /// Goes on with the change under way, or begins the next, as far as a cloth at x allows on this level.
  /// Gives the part of what was left of it that has been made.
  virtual StepLimit advance(int level, const Positions& x) = 0;
  /// Goes on with the change under way by this part of what is left of it if a cloth at x allows all of that;
  /// if not, false, and nothing is changed.
  virtual bool advance_by(double part, int level, const Positions& x) = 0;
};

/// What a level came to under one of its conditions, as observers see it.
struct ChangeRow {
  int level = 0, change = 0;
  double time = 0;              ///< pseudo-time
  int steps = 0;                ///< since the change was begun
  int iterations = 0;           ///< likewise
  double seconds = 0;           ///< likewise
  double energy = 0;            ///< of what is minimised, without friction [J]
  double force_residual = 0;    ///< [1]
  double farthest_missing = 0;  ///< of held vertices from their places [m]
};

}  // namespace drape
