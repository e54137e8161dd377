#pragma once

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/declaration.h"
#include "core/numerics/solve/newton.h"

namespace drape {

/// A method that solves levels from coarse to fine by Newton's method. A solver that derives from it says
/// what a level minimises, and declares its own parameters and, by declare_newton, Newton's.
class Progression : public Solver {
 public:
  NewtonParameters newton;

  template <class Derived>
  static void declare_newton(Declaration<Derived>& d) {
    d.add_section("newton", &Derived::newton, "settings of the Newton solves");
  }

  /// What a level minimises; by default its own energy.
  virtual std::unique_ptr<Objective> objective(const Problem& problem, int level) const;
  /// The coarsest level that is solved.
  virtual int first_level([[maybe_unused]] const Problem& problem) const { return 0; }
  /// Whether a level starts from the state of the one before, prolonged by interpolation() and made feasible
  /// by refine_safely, and not from the scene's start. If that fails, it starts from the scene's start after
  /// all, and its result's message says why.
  virtual bool refines() const { return true; }

  /// Ends at the first cancelled level.
  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const final;
  bool can_resume() const final { return true; }
  std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                  Observer& observer) const final;
};

}  // namespace drape
