#pragma once

#include "core/kernel/model/energy.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// Discrete hinge bending (docs/theory/method.md, section 5): Σ_e k · 3 ‖ē‖² / (Ā₁ + Ā₂) (θ - θ̄)² with
/// k = E_bend d³ / (24 (1 - ν²)) and θ̄ from the rest shape.
class Hinge final : public Energy {
 public:
  struct Parameters {
    static void declare(Declaration<Parameters>&) {}
  };

  explicit Hinge(const Parameters&) {}
  EnergyRole role() const override { return EnergyRole::bending; }
  double plate_stiffness(const Material& material) const override;
  std::optional<double> midpoint_factor() const override { return 2; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;
};

}  // namespace drape
