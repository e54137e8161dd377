#pragma once

#include <functional>

#include "core/numerics/solve/newton.h"

namespace drape {

struct MethodState;

/// Solves coarse to fine: minimises objective(l) on every level l.
///
/// Level 0 starts from the scene's start. Level l + 1 starts from the state of level l, prolonged by
/// weights[l] and made feasible by refine_safely; if that fails, from the scene's start, and its result's
/// message says why. Stops at the first cancelled level. Resumes from the state `from`.
std::vector<LevelResult> solve_progressively(
    const Problem& problem, const std::vector<ProlongationMatrix>& weights,
    const std::function<std::unique_ptr<Objective>(int level)>& objective, const NewtonParameters& newton,
    const MethodState& from, Observer& observer);

}  // namespace drape
