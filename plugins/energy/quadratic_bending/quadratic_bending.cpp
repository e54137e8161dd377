#include "plugins/energy/quadratic_bending/quadratic_bending.h"

#include <sstream>
#include <stdexcept>

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/bending_stiffness.h"
#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/element_energy.h"
#include "plugins/energy/quadratic_bending/quadratic_bending_kernel.h"

namespace drape {
namespace {

void require_flat(const Eigen::Vector3d* d, const Level& level, int v0, int v1) {
  const Eigen::Vector3d n1 = d[0].cross(d[1]), n2 = d[2].cross(d[0]);
  const double angle = std::atan2(n1.cross(n2).norm(), n1.dot(n2));
  if (n1.norm() > 0 && n2.norm() > 0 && angle <= 1e-6) return;
  std::ostringstream text;
  text << "quadratic_bending: the rest shape of level " << level.index << " is not flat (angle " << angle
       << " at the edge of vertices " << v0 << " and " << v1 << "); use hinge";
  throw std::runtime_error(text.str());
}

}  // namespace

// Three times a plate's on a grid of right-angled or equilateral triangles (docs/results/validation.md).
double QuadraticBending::plate_stiffness(const Material& material) const {
  return 6 * bending_stiffness(material);
}

std::unique_ptr<BoundEnergy> QuadraticBending::bind(const Level& level, const Material& material) const {
  const double k = bending_stiffness(material);
  const Stencils& hinges = level.hinges;
  std::vector<QuadraticBendingKernel::Rest> rest;
  for (Eigen::Index h = 0; h < hinges.rows(); ++h) {
    const std::array<Eigen::Vector3d, 3> d = rest_vectors(level, h);
    require_flat(d.data(), level, hinges(h, 0), hinges(h, 1));
    rest.push_back(QuadraticBendingKernel::rest(d.data(), k));
  }
  return std::make_unique<ElementEnergy<QuadraticBendingKernel>>(hinges, rest, level.hinge_order);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::QuadraticBending>(
      "quadratic_bending", "Bending with a constant matrix, for flat rest shapes that hardly stretch.");
}
