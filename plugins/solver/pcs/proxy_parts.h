#pragma once

#include <vector>

#include "core/kernel/plugin/parameters.h"
#include "plugins/solver/pcs/proxy_objective.h"

namespace drape {

/// Interpolation through which a proxy's energies see the fine mesh, for each role.
struct ProxyInterpolation {
  Interpolation membrane = Interpolation::midpoint;
  Interpolation bending = Interpolation::midpoint;
  Interpolation external = Interpolation::midpoint;
  Interpolation state = Interpolation::midpoint;
  static void declare(Declaration<ProxyInterpolation>& d);
};

/// Parts of the proxy of a coarse level for the finest model. An energy that midpoint refinement multiplies
/// by a known factor (Energy::midpoint_factor) is evaluated on the level itself, any other on the finest one.
/// The matrix of the latter is that of the model `depth` levels up, at most the finest. The parts refer to
/// the problem's hierarchy.
std::vector<ProxyPart> proxy_parts(const Problem& problem, int level, int depth,
                                   const ProxyInterpolation& interpolation);

}  // namespace drape
