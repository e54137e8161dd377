#pragma once

#include "core/app/scene/scene.h"

namespace drape {

/// Throws std::runtime_error for a level that the scene does not have.
void require_level(const Scene& scene, int level);
/// Throws std::runtime_error for x (n×3) [m] that is not a state of the level: with other vertices, or not
/// finite.
void require_state(const Scene& scene, int level, const Positions& x);

/// The result with an outcome that does not rest on the method's word: one that has converged must have the
/// schedule at its end, its Dirichlet vertices at their targets and, on the finest level, which every method
/// solves by its plain model, forces in balance within ten times the tolerance [1], whatever residual it
/// reports; one that has converged to rounding, within ten times that or the bound of round-off. The balance
/// has in it whatever friction the contacts at the end can exert: how much of that acts is known to the
/// method only.
LevelResult audited(const Scene& scene, LevelResult result, double force_tolerance);

}  // namespace drape
