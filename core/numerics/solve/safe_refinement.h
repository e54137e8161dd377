#pragma once

#include <string>

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"

namespace drape {

/// A state prolonged to the next finer level.
struct Refined {
  Positions x;
  std::string fault;       ///< why it is infeasible, naming triangles; empty if it is feasible
  bool cancelled = false;  ///< the observer requested a stop
  int iterations = 0, factorisations = 0, analyses = 0;
  double flops = 0;
  double seconds = 0;
};

/// Prolongs the state x of `level` to the next one by `weights`, free of intersections and within the strain
/// limits (PCS section 4.3).
///
/// The result is y^p = weights · x if that satisfies contact and limits. Otherwise the midpoint split, which
/// does not move the surface, starts a descent towards y^p on
///   1/(2h²) ‖y − y^p‖²_M + B(y) + S(y)|_F + κ_a Σ_{f ∉ F} V_f Σ_i (σ_i − 1)²,
/// F the triangles within their limit. While triangles violate their limit, each round relaxes the target by
/// a factor of ten in 1/h².
Refined refine_safely(const Problem& problem, int level, const Positions& x,
                      const ProlongationMatrix& weights, const Stopwatch& clock, Observer& observer);

}  // namespace drape
