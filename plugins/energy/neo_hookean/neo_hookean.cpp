#include "plugins/energy/neo_hookean/neo_hookean.h"

#include "core/kernel/plugin/plugin.h"
#include "plugins/energy/neo_hookean/neo_hookean_law.h"

namespace drape {

std::unique_ptr<BoundEnergy> NeoHookean::bind(const Level& level, const Material& material) const {
  return bind_membrane<NeoHookeanLaw>(level, material);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::NeoHookean>(
      "neo_hookean", "Neo-Hookean membrane in plane stress; resists collapse of triangles.");
}
