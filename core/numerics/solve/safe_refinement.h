#pragma once

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"

namespace drape {

/// Prolongs the state x of `level` to the next one by `weights`, free of intersections and within the strain
/// limits (PCS section 4.3). An outcome `stalled` has a message that names the triangles beyond their limits.
///
/// The result is y^p = weights · x, with the hierarchy's offsets, if that satisfies contact and limits.
/// Otherwise the midpoint split, which does not move the surface, or, where the next level does not split
/// this one and y^p intersects something, the scene's start, starts a descent towards y^p on
///   1/(2h²) ‖y − y^p‖²_M + B(y) + S(y)|_F + κ_a Σ_{f ∉ F} V_f Σ_i (σ_i − 1)²,
/// F the triangles within their limit. While triangles violate their limit, each round relaxes the target by
/// a factor of ten in 1/h².
LevelResult refine_safely(const Problem& problem, int level, const Positions& x,
                          const ProlongationMatrix& weights, const Stopwatch& clock, Observer& observer);

}  // namespace drape
