#pragma once

#include "core/kernel/model/energy.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// Weight, E = -Σ m_i a · x_i with m_i = ρ d A_i, A_i the level's vertex areas.
class Gravity final : public Energy {
 public:
  struct Parameters {
    Eigen::Vector3d acceleration{0, 0, -9.81};
    static void declare(Declaration<Parameters>& d) {
      d.add("acceleration", &Parameters::acceleration)
          .unit("m/s²")
          .at_least(-1e7)
          .at_most(1e7)
          .description("acceleration of free fall")
          .source("standard gravity, rounded; z is up");
    }
  };

  explicit Gravity(const Parameters& parameters) : p_(parameters) {}
  EnergyRole role() const override { return EnergyRole::external; }
  std::optional<double> midpoint_factor() const override { return 1; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;

 private:
  Parameters p_;
};

}  // namespace drape
