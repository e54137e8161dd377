#pragma once

#include <string>

#include "core/kernel/interfaces/solver.h"
#include "core/numerics/step/factor_cache.h"
#include "core/numerics/step/iterate.h"

namespace drape {

/// An equilibrium's stability, and its least stable motion.
struct StabilityTest {
  std::string fault;  ///< why the equilibrium could not be judged; empty: it was
  Stability stability;
  Positions mode;        ///< n×3, of the curvature ratio: largest entry 1 or −1, rows of fixed vertices 0
  double curvature = 0;  ///< vᵀHv of this v [N/m]
};

/// Tests whether the Hessian H of the objective at the iterate, an equilibrium, is positive definite on the
/// free vertices: unprojected, with contact, strain limits and lagged friction.
///
/// Where levels are factorised, a factorisation of H decides; elsewhere iterations that multigrid
/// preconditions. Negative eigenvalues that the forces left out of balance can feign, such as those of a
/// cloth that is free to slide or to turn, count as neutral. There is a fault if H has entries that are
/// not finite, if it has no factor as a preconditioner, or if iterations run out. With `verdict_only` a
/// stable equilibrium has neither numbers nor a mode, which takes a third of the time.
StabilityTest test_stability(Iterate& iterate, FactorCache& factor, bool verdict_only);

}  // namespace drape
