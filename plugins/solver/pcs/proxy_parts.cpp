#include "plugins/solver/pcs/proxy_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"

namespace drape {

void ProxyInterpolation::declare(Declaration<ProxyInterpolation>& d) {
  const auto add = [&](const char* name, Interpolation ProxyInterpolation::*value) {
    return d.add_choice(name, value,
                        {{"midpoint", Interpolation::midpoint}, {"refiner", Interpolation::refiner}});
  };
  add("membrane", &ProxyInterpolation::membrane)
      .description("surface on which stretching is measured: the coarse one, or the refiner's, which locks")
      .source("PCS section 4 for refiner; midpoint is a departure (docs/theory/locking.md)");
  add("bending", &ProxyInterpolation::bending)
      .description(
          "surface on which bending is measured: the coarse one with folds at its edges, or the refiner's")
      .source("PCS section 4 for refiner; midpoint is a departure (docs/theory/locking.md)");
  add("external", &ProxyInterpolation::external)
      .description("surface on which loads and handles act")
      .source("PCS section 4 for refiner; midpoint is a departure (docs/theory/locking.md)");
  add("state", &ProxyInterpolation::state)
      .description("prolongs a level's state to the next level")
      .source("PCS section 4.3 for refiner; midpoint is a departure (docs/theory/locking.md)");
}

std::vector<ProxyPart> proxy_parts(const Problem& problem, int level, int depth,
                                   const ProxyInterpolation& interpolation) {
  const int above = problem.finest() - level;
  std::vector<ProxyPart> parts;
  const auto add = [&](const ProxyPart& wanted, EnergyRole role) {
    for (ProxyPart& part : parts)
      if (part.above == wanted.above && part.factor == wanted.factor &&
          part.interpolation == wanted.interpolation) {
        part.roles.add(role);
        return;
      }
    parts.push_back(wanted);
    parts.back().roles.add(role);
  };
  for (const auto& [role, interpolated_by] : {std::pair(EnergyRole::membrane, interpolation.membrane),
                                              std::pair(EnergyRole::external, interpolation.external),
                                              std::pair(EnergyRole::position, interpolation.external),
                                              std::pair(EnergyRole::bending, interpolation.bending)}) {
    ProxyPart part;
    const auto factor = problem.model(level)->midpoint_factor(role);
    if (interpolated_by == Interpolation::midpoint && factor) {
      part.factor = std::pow(*factor, above);
    } else {
      part.above = above;
      part.matrix_above = std::min(depth, above);
      part.interpolation = &problem.hierarchy.weights(interpolated_by);
    }
    add(part, role);
  }
  return parts;
}

}  // namespace drape
