#pragma once

#include <functional>
#include <string>

#include "core/numerics/step/equilibrium_check.h"
#include "core/numerics/step/factor_cache.h"
#include "core/numerics/step/implicit_step.h"
#include "core/numerics/step/line_search.h"
#include "core/numerics/step/step_controller.h"

namespace drape {

/// Solves one implicit step after another by Newton iterations: direction from the factorised matrix, line
/// search, damping.
class NewtonStep {
 public:
  /// At the beginning of a step.
  struct State {
    int max_iterations = 1;  ///< of the step
    StepController::State controller;
    double step_length = 1;  ///< α of the last line search
    FactorCache::State factor;
  };
  State state() const {
    return {step_.max_iterations(), controller_.state(), line_search_.step_length(), factor_.state()};
  }
  /// The iterate must have been evaluated.
  void restore(const State& state);

  /// Refers to all arguments; `hierarchy` may be null. `report` is called after iteration k of a step and its
  /// check, and `interrupt` between two iterations of one step: true ends it.
  NewtonStep(Iterate& iterate, EquilibriumCheck& check, const NewtonParameters& parameters,
             std::function<void(int k)> report, std::function<bool()> interrupt,
             const Hierarchy* hierarchy = nullptr);

  /// Begins a step at the iterate; lags friction there.
  void begin();
  /// Solves the step that begin() began, to a fraction of the force tolerance or its iteration limit. Returns
  /// why no iterate with less energy can be found; empty if one was.
  std::string solve();
  /// Whether `interrupt` ended the last step.
  bool interrupted() const { return interrupted_; }
  StepController& controller() { return controller_; }

  /// Factorises the matrix at the iterate, without the model's Dirichlet vertices, `with_inertia` of a step
  /// or with that of the longest. Returns false if that fails; factor().fault() then says why.
  bool factorise(bool with_inertia);
  FactorCache& factor() { return factor_; }

  double step_length() const { return line_search_.step_length(); }  ///< α of the last line search
  double step_size() const;  ///< h [s]; +∞ for a step without inertia

 private:
  std::string iterate();
  bool is_solved_to(double fraction) const;

  Iterate& iterate_;
  EquilibriumCheck& check_;
  const NewtonParameters& p_;
  std::function<void(int)> report_;
  std::function<bool()> interrupt_;
  bool interrupted_ = false;
  ImplicitStep step_;
  StepController controller_;
  LineSearch line_search_;
  FactorCache factor_;
  Positions direction_;
};

}  // namespace drape
