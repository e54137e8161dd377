#pragma once

#include "core/kernel/model/energy.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// St. Venant–Kirchhoff membrane in plane stress (docs/theory/method.md, section 5); finite everywhere.
class Stvk final : public Energy {
 public:
  struct Parameters {
    static void declare(Declaration<Parameters>&) {}
  };

  explicit Stvk(const Parameters&) {}
  EnergyRole role() const override { return EnergyRole::membrane; }
  std::optional<double> midpoint_factor() const override { return 1; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;
  std::unique_ptr<BoundEnergy> bind_buckling(const Level& level, const Material& material,
                                             double s) const override;
};

}  // namespace drape
