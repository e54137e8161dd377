#pragma once

#include <functional>
#include <string>

#include "core/numerics/stability/stability_test.h"
#include "core/numerics/step/equilibrium_check.h"
#include "core/numerics/step/line_search.h"

namespace drape {

/// Tests the stability of equilibria and leaves those that are unstable.
///
/// The cloth walks along its least stable motion while the objective falls. What the motion strains to first
/// order only, as an inextensible column that bends, relaxes after each stride, with the stride held. Then
/// the level is solved to a tighter tolerance than its own: beside tension the forces of a wrinkle that grows
/// are within it at once.
class SaddleExit {
 public:
  struct State {
    int exits = 0;   ///< of the current increment
    int steps = -1;  ///< of the level at the last of them, while the tolerance is tightened; else −1
  };
  const State& state() const { return s_; }
  void restore(const State& state) { s_ = state; }

  /// Refers to all arguments. Calls `report` after each stride, an iteration.
  SaddleExit(Iterate& iterate, FactorCache& factor, EquilibriumCheck& check,
             const NewtonParameters& parameters, std::function<void()> report)
      : iterate_(iterate), factor_(factor), check_(check), p_(parameters), report_(std::move(report)) {}

  /// Tests the iterate, an equilibrium of an increment or at the end of the level, and stores the result. A
  /// saddle from which no walk lowers the objective by more than round-off counts as marginal. Returns
  /// whether the cloth has left one: then the check is to be restarted and tightened.
  bool leave(bool at_end);
  /// Tightens the tolerance after an exit, to be called once the check has been restarted.
  void tighten();
  /// Gives the tightened tolerance up if it takes too many steps: contact with friction may not reach it.
  void limit_steps();
  /// Begins another increment.
  void restart() { s_ = {}; }
  /// Whether the last equilibrium that was tested is unstable.
  bool at_saddle() const;
  /// What is wrong with it.
  std::string text() const;

 private:
  bool walk(const Positions& mode, double sign);
  void return_to(const Positions& x);
  void note_stride();
  void relax_across(const Positions& mode);

  Iterate& iterate_;
  FactorCache& factor_;
  EquilibriumCheck& check_;
  const NewtonParameters& p_;
  const std::function<void()> report_;
  LineSearch line_search_;
  State s_;
};

}  // namespace drape
