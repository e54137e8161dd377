#pragma once

#include <array>
#include <vector>

#include "core/plugin/parameters.h"
#include "plugins/solver/pcs/proxy_objective.h"

namespace drape {

/// By which interpolation a proxy's energies see the fine mesh, role by role.
struct ProxyInterpolation {
  Interpolation membrane = Interpolation::midpoint;
  Interpolation bending = Interpolation::midpoint;
  Interpolation external = Interpolation::midpoint;
  Interpolation state = Interpolation::midpoint;
  static void declare(Declaration<ProxyInterpolation>& d);
};

/// The parts of level l's proxy, which stands for the model `above` levels up: an energy that midpoints leave
/// equal to the level's own, or to a multiple of it (Energy::midpoint_factor), is evaluated there, any other
/// on the finer model.
std::vector<ProxyPart> proxy_parts(const Problem& problem, int level, int above, int depth,
                                   const ProxyInterpolation& interpolation);

}  // namespace drape
