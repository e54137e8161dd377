#include "core/numerics/elements/stretch_penalty.h"

#include <stdexcept>
#include <string>

#include "core/numerics/elements/element_energy.h"

namespace drape {

std::unique_ptr<BoundEnergy> make_stretch_penalty(const Level& level, double thickness, double stiffness,
                                                  const std::vector<char>& flags) {
  using Kernel = StretchKernel<StretchPenaltyLaw>;
  if (static_cast<int>(flags.size()) != level.triangle_count())
    throw std::runtime_error("stretch penalty: " + std::to_string(flags.size()) + " flags for " +
                             std::to_string(level.triangle_count()) + " triangles");
  std::vector<Kernel::Rest> rest;
  std::vector<int> chosen;
  for (int t = 0; t < level.triangle_count(); ++t) {
    if (!flags[t]) continue;
    const RestTriangle triangle = RestTriangle::of(level, t);
    rest.emplace_back(triangle.a, triangle.b, triangle.c, stiffness * thickness * triangle.area);
    chosen.push_back(t);
  }
  Stencils elements(chosen.size(), 3);
  for (std::size_t i = 0; i < chosen.size(); ++i) elements.row(i) = level.rest.triangles.row(chosen[i]);
  return std::make_unique<ElementEnergy<Kernel>>(elements, rest,
                                                 ElementOrder::of(elements, level.rest.vertices));
}

}  // namespace drape
