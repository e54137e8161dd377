#pragma once

#include "core/app/dressing/phase.h"

namespace drape {

/// What keeps pinned vertices up until pins hold: a waist would go down with the many metres of a skirt that
/// is placed below it, to be gathered, because cloth without loads keeps its centre of mass. Of each pin,
/// k/2 min(0, m − m₀)²: m is the mean height of its vertices by their areas, m₀ two centimetres below where
/// they were placed, up against the loads, and k the stiffness of a square of the cloth, thickness × mean
/// membrane modulus. Null without pins, or if the loads have no sum. Its Hessian is k diag(w) ≥ k w wᵀ, w the
/// vertices' shares of the area, which is exact where they move together and has no entries between them.
/// Refers to the scene.
std::shared_ptr<const Energy> pin_support(const DressingSetup& setup);

}  // namespace drape
