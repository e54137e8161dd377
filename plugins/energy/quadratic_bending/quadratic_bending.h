#pragma once

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// Isometric quadratic bending (Bergou et al. 2006) with the hinge's stiffness; flat rest shapes only.
class QuadraticBending final : public Energy {
 public:
  EnergyRole role() const override { return EnergyRole::bending; }
  double plate_stiffness(const Material& material) const override;
  std::optional<double> midpoint_factor() const override { return 2; }
  /// Throws std::runtime_error if a hinge's rest angle is above 1e-6.
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;
};

}  // namespace drape
