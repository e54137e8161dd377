#include "core/numerics/elements/stretch_penalty.h"

#include "core/numerics/elements/element_energy.h"

namespace drape {

std::unique_ptr<BoundEnergy> make_stretch_penalty(const Level& level, double thickness, double stiffness,
                                                  const std::vector<char>& flags) {
  using Kernel = StretchKernel<StretchPenaltyLaw>;
  std::vector<Kernel::Rest> rest;
  std::vector<int> chosen;
  for (int t = 0; t < level.triangle_count(); ++t) {
    if (!flags[t]) continue;
    const RestTriangle triangle = RestTriangle::of(level, t);
    rest.emplace_back(triangle.a, triangle.b, triangle.c, stiffness * thickness * triangle.area);
    chosen.push_back(t);
  }
  const Stencils elements = level.rest.triangles(chosen, Eigen::all);
  return std::make_unique<ElementEnergy<Kernel>>(elements, rest,
                                                 ElementOrder::of(elements, level.rest.vertices));
}

}  // namespace drape
