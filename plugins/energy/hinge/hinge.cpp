#include "plugins/energy/hinge/hinge.h"

#include <stdexcept>
#include <string>

#include "core/kernel/elements/bending_stiffness.h"
#include "core/kernel/elements/dihedral_angle.h"
#include "core/kernel/elements/element_energy.h"
#include "core/kernel/plugin/plugin.h"
#include "plugins/energy/hinge/hinge_kernel.h"

namespace drape {

// Three times a plate's on a grid of right-angled or equilateral triangles (docs/results/validation.md).
double Hinge::plate_stiffness(const Material& material) const { return 6 * bending_stiffness(material); }

std::unique_ptr<BoundEnergy> Hinge::bind(const Level& level, const Material& material) const {
  const double k = bending_stiffness(material);
  const Stencils& hinges = level.hinges;
  std::vector<HingeKernel::Rest> rest;
  for (Eigen::Index h = 0; h < hinges.rows(); ++h) {
    rest.push_back(HingeKernel::rest(rest_vectors(level, h).data(), k));
    if (!rest.back().allFinite())
      throw std::runtime_error("hinge: a triangle at the edge of vertices " + std::to_string(hinges(h, 0)) +
                               " and " + std::to_string(hinges(h, 1)) + " of level " +
                               std::to_string(level.index) + " has no area at rest");
  }
  return std::make_unique<ElementEnergy<HingeKernel>>(hinges, rest, level.hinge_order);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::Hinge>("hinge",
                                            "Bending by the angles between triangles, any rest shape.");
}
