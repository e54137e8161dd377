#pragma once

#include <string>

#include "core/numerics/model/level_model.h"

namespace drape {

/// A message that names the gap, the barrier stiffness and a suitable one, if a contact model's barrier is
/// too weak for the load. Empty if no gap is far below d̂, or if a gap closed for another reason. Costs one
/// search for contacts.
std::string weak_barrier(const LevelModel& model, const Positions& x);

}  // namespace drape
