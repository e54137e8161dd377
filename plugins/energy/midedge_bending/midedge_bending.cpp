#include "plugins/energy/midedge_bending/midedge_bending.h"

#include <cmath>

#include "core/kernel/plugin/plugin.h"
#include "plugins/energy/midedge_bending/bound_midedge_bending.h"

namespace drape {

std::unique_ptr<BoundEnergy> MidedgeBending::bind(const Level& level, const Material& material) const {
  const double nu = material.poisson_ratio;
  const double k = material.bending_modulus * std::pow(material.thickness, 3) / (24 * (1 - nu * nu));
  return std::make_unique<BoundMidedgeBending>(
      level, ShapeOperators::of(level, k, nu, parameters_.correction_tolerance));
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::MidedgeBending>(
      "midedge_bending", "Bending of a plate by normals at edges, on any triangulation, any rest shape.");
}
