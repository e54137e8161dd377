#pragma once

#include <string>

#include "core/model/level_model.h"

namespace drape {

/// Whether a contact model's barrier is too weak for the load, in words: which gap shows it, what the
/// stiffness is and what to set it to. Empty where no gap is far below the barrier's range, or where
/// something else than a weak barrier has closed it. For messages: it takes a search for contacts.
std::string weak_barrier(const LevelModel& model, const Positions& x);

}  // namespace drape
