#pragma once

#include <string>

#include "core/numerics/model/objective.h"
#include "core/numerics/solve/load_stepper.h"
#include "core/numerics/step/newton_parameters.h"
#include "core/numerics/step/newton_step.h"

namespace drape {

/// The row of an iteration, `seconds` after the clock began.
IterationRow iteration_row(const Iterate& iterate, const NewtonStep& step, const LoadStepper& load,
                           int iteration, double seconds);

/// Stores the contacts' stiffness, their smallest gap and the time that they took.
void record_contacts(const ActiveContacts& contacts, LevelResult& result);

/// Why a cloth that has drifted by `drift` of its diagonals [1], more than `most`, will not come to rest.
std::string drift_text(double drift, double most, const LevelModel& model);

/// Tells which tolerance is not met, and whether the force residual still falls.
std::string max_steps_text(const LevelResult& so_far, const NewtonParameters& p,
                           const EquilibriumCheck& check);

/// Why a state that misses a tolerance counts as converged: round-off explains `rounding` of its residual.
std::string rounding_text(const LevelResult& so_far, const NewtonParameters& p, double rounding);

/// A message that names the gap, the barrier stiffness and a suitable one, if a contact model's barrier is
/// too weak for the load. Empty if no gap is far below d̂, or if a gap closed for another reason. Costs one
/// search for contacts.
std::string weak_barrier(const LevelModel& model, const Positions& x);

}  // namespace drape
