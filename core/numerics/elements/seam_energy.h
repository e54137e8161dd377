#pragma once

#include <functional>
#include <memory>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// An energy that `bind` binds to the level. Where its elements are the level's hinges, that of seams has the
/// factor of the level's seams.
std::unique_ptr<BoundEnergy> bind_with_seams(
    const Level& level, const std::function<std::unique_ptr<BoundEnergy>(const Level&)>& bind);

}  // namespace drape
