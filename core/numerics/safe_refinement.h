#pragma once

#include <string>

#include "core/model/solver.h"
#include "core/numerics/stopwatch.h"

namespace drape {

/// A state carried to the next finer level.
struct Refined {
  Positions x;
  std::string fault;       ///< why it is not allowed there, naming primitives; empty if it is
  bool cut_short = false;  ///< stopped on the way, on request
  int iterations = 0;
  double seconds = 0;
};

/// Carries the state x of `level` to the next one by `weights`, without an intersection and within the strain
/// limits. That is weights · x where the finer level has neither contact nor limits, or neither is in the
/// way. Otherwise it starts from the midpoint split, which leaves the surface where it is, and descends
/// towards y^p = weights · x on
///   1/(2h²) ‖y − y^p‖²_M + B(y) + S(y)|_F + κ_a Σ_{f ∉ F} V_f Σ_i (σ_i − 1)²,
/// F the triangles within their limit (PCS section 4.3). The target is let go of, tenfold a round, where it
/// keeps triangles beyond their limit.
Refined refine_safely(const Problem& problem, int level, const Positions& x,
                      const ProlongationMatrix& weights, const Stopwatch& clock, Observer& observer);

}  // namespace drape
