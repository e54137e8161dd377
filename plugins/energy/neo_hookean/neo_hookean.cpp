#include "plugins/energy/neo_hookean/neo_hookean.h"

#include "core/kernel/elements/buckling_membrane.h"
#include "core/kernel/plugin/plugin.h"
#include "plugins/energy/neo_hookean/neo_hookean_law.h"

namespace drape {

std::unique_ptr<BoundEnergy> NeoHookean::bind(const Level& level, const Material& material) const {
  return bind_membrane<NeoHookeanLaw>(level, material);
}

std::unique_ptr<BoundEnergy> NeoHookean::bind_buckling(const Level& level, const Material& material,
                                                       double s) const {
  return bind_buckling_membrane<NeoHookeanLaw>(level, material, s);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::NeoHookean>(
      "neo_hookean", "Neo-Hookean membrane in plane stress; resists collapse of triangles.");
}
