#pragma once

#include <functional>
#include <memory>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// The energy times a factor ≥ 0, with the same stencils on every level.
std::shared_ptr<const Energy> scaled(std::shared_ptr<const Energy> energy, double factor);

/// Binds an energy to the level. If its elements are the level's hinges, each hinge has a factor: the level's
/// seam stiffness on seams, times its entry of `factors` (one a hinge, rounded to a quarter of an octave;
/// empty: all are 1).
std::unique_ptr<BoundEnergy> bind_with_seams(
    const Level& level, const std::function<std::unique_ptr<BoundEnergy>(const Level&)>& bind,
    const Eigen::VectorXd& factors = {});

}  // namespace drape
