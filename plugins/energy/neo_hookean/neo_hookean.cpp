#include "plugins/energy/neo_hookean/neo_hookean.h"

#include <stdexcept>
#include <string>

#include "core/numerics/element_energy.h"
#include "core/plugin/plugin.h"
#include "plugins/energy/neo_hookean/neo_hookean_kernel.h"

namespace drape {

std::unique_ptr<BoundEnergy> NeoHookean::bind(const Level& level, const Material& material) const {
  const Positions& places = level.rest.vertices;
  std::vector<NeoHookeanKernel::Rest> rest;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    rest.push_back(NeoHookeanKernel::rest(places.row(v[1]) - places.row(v[0]),
                                          places.row(v[2]) - places.row(v[0]), material.thickness,
                                          material.membrane_modulus, material.poisson_ratio));
    if (!rest.back().allFinite())
      throw std::runtime_error("neo_hookean: triangle " + std::to_string(t) + " of level " +
                               std::to_string(level.index) + " has no area at rest");
  }
  return std::make_unique<ElementEnergy<NeoHookeanKernel>>(level.rest.triangles, rest, level.triangle_order);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::NeoHookean>(
      "neo_hookean", "Neo-Hookean membrane in plane stress; resists collapse of triangles.");
}
