#pragma once

#include <functional>

#include "core/numerics/newton.h"

namespace drape {

/// Coarse to fine: minimises objective(l) on every level l, from the scene's start on level 0 and from the
/// last level's state, carried up safely by weights[l], on the others; where that is not allowed, from the
/// scene's start, which the result's message says. Ends at the first level that was cancelled; a level that
/// the observer asks to refine early leaves its state to the next. Goes on from where `from` says.
std::vector<LevelResult> solve_progressively(
    const Problem& problem, const std::vector<ProlongationMatrix>& weights,
    const std::function<std::unique_ptr<Objective>(int level)>& objective, const NewtonParameters& newton,
    const MethodState& from, Observer& observer);

}  // namespace drape
