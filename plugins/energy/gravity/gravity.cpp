#include "plugins/energy/gravity/gravity.h"

#include "core/kernel/elements/linear_energy.h"
#include "core/kernel/plugin/plugin.h"

namespace drape {

std::unique_ptr<BoundEnergy> Gravity::bind(const Level& level, const Material& material) const {
  return std::make_unique<LinearEnergy>(material.area_density() * level.vertex_area *
                                        p_.acceleration.transpose());
}

}  // namespace drape

DRAPE_PLUGIN(registry) { registry.add<drape::Energy, drape::Gravity>("gravity", "Weight of the cloth."); }
