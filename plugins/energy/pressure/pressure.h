#pragma once

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// Follower pressure E = -p V(x) with the enclosed volume V. A cone from its border to a fixed centre closes
/// an open cloth.
class Pressure final : public Energy {
 public:
  struct Parameters {
    double pressure = 0;
    Eigen::Vector3d centre{0, 0, 0};
    static void declare(Declaration<Parameters>& d) {
      d.add("pressure", &Parameters::pressure)
          .unit("Pa")
          .at_least(-bounds::largest_load)
          .at_most(bounds::largest_load)
          .required()
          .description("pressure along the normal of every triangle; negative for suction")
          .source("this project");
      d.add("centre", &Parameters::centre)
          .unit("m")
          .at_least(-bounds::largest_coordinate)
          .at_most(bounds::largest_coordinate)
          .description(
              "apex of the cone that closes an open cloth; it has no effect on a pinned border or a closed "
              "mesh")
          .source("this project");
    }
  };

  explicit Pressure(const Parameters& parameters) : p_(parameters) {}
  EnergyRole role() const override { return EnergyRole::external; }
  std::optional<double> midpoint_factor() const override { return 1; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;

 private:
  Parameters p_;
};

}  // namespace drape
