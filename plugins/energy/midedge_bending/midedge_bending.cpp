#include "plugins/energy/midedge_bending/midedge_bending.h"

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/bending_stiffness.h"
#include "plugins/energy/midedge_bending/bound_midedge_bending.h"

namespace drape {

double MidedgeBending::plate_stiffness(const Material& material) const {
  return 2 * bending_stiffness(material);
}

std::unique_ptr<BoundEnergy> MidedgeBending::bind(const Level& level, const Material& material) const {
  return std::make_unique<BoundMidedgeBending>(
      level, ShapeOperators::of(level, material, parameters_.correction_tolerance));
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::MidedgeBending>(
      "midedge_bending", "Bending of a plate by normals at edges, on any triangulation, any rest shape.");
}
