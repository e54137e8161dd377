#include "plugins/energy/constant_load/constant_load.h"

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/linear_energy.h"

namespace drape {

std::unique_ptr<BoundEnergy> ConstantLoad::bind(const Level& level, const Material&) const {
  Positions forces = level.vertex_area * p_.force_density.transpose();
  for (const PointForce& load : p_.points) {
    Eigen::Index nearest;
    (level.rest.vertices.rowwise() - load.point.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    forces.row(nearest) += load.force.transpose();
  }
  return std::make_unique<LinearEnergy>(std::move(forces));
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::ConstantLoad>("constant_load",
                                                   "Constant forces: by rest area, and on single vertices.");
}
