#include "plugins/energy/stvk/stvk.h"

#include "core/kernel/elements/buckling_membrane.h"
#include "core/kernel/plugin/plugin.h"
#include "plugins/energy/stvk/stvk_law.h"

namespace drape {

std::unique_ptr<BoundEnergy> Stvk::bind(const Level& level, const Material& material) const {
  return bind_membrane<StvkLaw>(level, material);
}

std::unique_ptr<BoundEnergy> Stvk::bind_buckling(const Level& level, const Material& material,
                                                 double s) const {
  return bind_buckling_membrane<StvkLaw>(level, material, s);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::Stvk>(
      "stvk", "St. Venant–Kirchhoff membrane; cheap, right for small strains, weak under compression.");
}
