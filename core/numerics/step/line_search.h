#pragma once

#include "core/numerics/step/implicit_step.h"

namespace drape {

/// Backtracking line search of an implicit step, from the largest step that limits and contact allow, to
/// Armijo's sufficient decrease. Where the energy changes by round-off only, the norm of the gradient
/// decides.
class LineSearch {
 public:
  /// The shortest step that is tried, as a fraction of the direction.
  static constexpr double min_step_length = 1e-6;

  /// Moves the iterate, at which `step` was evaluated, along the direction p (n×3) [m]. Returns false, with
  /// the iterate as it was, if p does not descend or no step length is accepted.
  bool search(Iterate& iterate, const ImplicitStep& step, const Positions& direction);

  /// α of the last search that had a descent direction, in [0, 1].
  double step_length() const { return step_length_; }
  /// Restores α from a checkpoint, or sets that of a step which no search has moved.
  void set_step_length(double step_length) { step_length_ = step_length; }
  /// Slope of the step's energy along the last direction [J].
  double slope() const { return slope_; }

 private:
  double step_length_ = 1, slope_ = 0;
  Positions trial_, trial_gradient_;
};

}  // namespace drape
