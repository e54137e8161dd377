#include "plugins/energy/stvk/stvk.h"

#include "core/kernel/plugin/plugin.h"
#include "plugins/energy/stvk/stvk_law.h"

namespace drape {

std::unique_ptr<BoundEnergy> Stvk::bind(const Level& level, const Material& material) const {
  return bind_membrane<StvkLaw>(level, material);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::Stvk>(
      "stvk", "St. Venant–Kirchhoff membrane; cheap, right for small strains, weak under compression.");
}
