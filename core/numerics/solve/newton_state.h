#pragma once

#include <optional>
#include <vector>

#include "core/kernel/interfaces/solver.h"
#include "core/numerics/model/active_contacts.h"
#include "core/numerics/solve/dirichlet_enforcer.h"
#include "core/numerics/solve/load_stepper.h"
#include "core/numerics/stability/saddle_exit.h"
#include "core/numerics/step/newton_step.h"

namespace drape {

/// State of a level at the beginning of an implicit step: everything on which later steps depend, bit for
/// bit. Energy, gradient, contacts and the layout of the factor are recomputed from it.
struct NewtonState {
  LevelResult so_far;  ///< x, counts and seconds up to here

  // The states of the solver's parts.
  Iterate::State iterate;
  NewtonStep::State step;
  EquilibriumCheck::State check;
  DirichletEnforcer::State dirichlet;
  LoadStepper::State load_stepper;
  SaddleExit::State saddle_exit;
  ContactMemory contacts;
  bool switched_to_plain = false;  ///< the objective was a proxy and is now the plain energy
};

/// State of a method, between two levels or within one.
struct MethodState {
  std::vector<LevelResult> finished;     ///< in order
  int level = 0;                         ///< the level to continue with
  std::optional<NewtonState> under_way;  ///< state of that level; none if it has not begun
  double seconds = 0;                    ///< of the method so far

  /// The state of level l if it is under way, else null.
  const NewtonState* of(int l) const { return l == level && under_way ? &*under_way : nullptr; }
};

/// Returns the levels of a problem to the loads that they had in the state.
inline void restore_load_stepping(const Problem& problem, const MethodState& state) {
  if (!problem.load_stepping) return;
  for (const LevelResult& level : state.finished)
    problem.load_stepping->restore(level.level, level.load_stepping);
  if (state.under_way) problem.load_stepping->restore(state.level, state.under_way->so_far.load_stepping);
}

}  // namespace drape
