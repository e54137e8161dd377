#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

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
    int exits = 0;  ///< of the current increment
    std::optional<int>
        tightened_at;  ///< steps of the level at the last exit, while the tolerance is tightened
  };
  const State& state() const { return s_; }
  void restore(const State& state) { s_ = state; }

  /// Refers to all arguments. Calls `report` after each relaxation, an iteration, and asks before each stride
  /// whether to `stop`.
  SaddleExit(Iterate& iterate, FactorCache& factor, EquilibriumCheck& check,
             const NewtonParameters& parameters, std::function<void()> report, std::function<bool()> stop)
      : iterate_(iterate),
        factor_(factor),
        check_(check),
        p_(parameters),
        report_(std::move(report)),
        stop_(std::move(stop)) {}

  /// Tests the iterate, an equilibrium of an increment or at the end of the level, and stores the result. A
  /// saddle from which no walk lowers the objective by more than round-off counts as marginal. Returns
  /// whether the cloth has left one; the tolerance is then tightened.
  bool leave(bool at_end);
  /// Whether a walk was stopped.
  bool is_stopped() const { return stopped_; }
  /// Returns to the level's own tolerance. Returns whether it was tightened.
  bool end_tightening();
  /// Ends it after many steps: contact with friction may not reach the tightened one.
  void limit_tightening();
  /// Begins another increment.
  void restart();
  /// Whether the last equilibrium that was tested is unstable.
  bool at_saddle() const;
  /// A message on it.
  std::string text() const;
  /// Why the equilibrium at the end of the level could not be judged; empty if it was, or is not tested.
  const std::string& fault() const { return fault_; }

 private:
  bool walk(const StabilityTest& test, double sign);
  void return_to(const Positions& x);
  void relax_across(const Positions& mode);
  void note_relaxation();

  Iterate& iterate_;
  FactorCache& factor_;
  EquilibriumCheck& check_;
  const NewtonParameters& p_;
  const std::function<void()> report_;
  const std::function<bool()> stop_;
  bool stopped_ = false;
  bool factor_serves_ = false;  // the walk's
  std::string fault_;
  double observed_ = 0;  // seconds that observers of relaxations took
  LineSearch line_search_;
  State s_;
};

}  // namespace drape
