#pragma once

#include <functional>
#include <memory>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// An energy that `bind` binds to the level. Where its elements are the level's hinges, that of each has the
/// factor of the level's seams if it is one, and one of `factors` (h), which are 1 if there are none and else
/// rounded to a quarter of an octave.
std::unique_ptr<BoundEnergy> bind_with_seams(
    const Level& level, const std::function<std::unique_ptr<BoundEnergy>(const Level&)>& bind,
    const Eigen::VectorXd& factors = {});

}  // namespace drape
