#include "core/app/dressing/load_forces.h"

#include "core/numerics/model/required.h"

namespace drape {

Positions load_forces(const Experiment& e, const Level& level, const Positions& x) {
  Positions gradient = Positions::Zero(x.rows(), 3);
  for (const NamedEnergy& named : e.energies)
    if (named.energy->role() == EnergyRole::external)
      bound_energy(*named.energy, level, e.parameters.material)->add_gradient(x, gradient);
  return -gradient;
}

std::optional<Eigen::RowVector3d> upward(const Positions& forces) {
  constexpr double rounding = 1e-9;  // a smaller part of all forces is no sum of them
  const Eigen::RowVector3d sum = forces.colwise().sum();
  if (!(sum.norm() > rounding * forces.rowwise().norm().sum())) return std::nullopt;
  return -sum.normalized();
}

}  // namespace drape
