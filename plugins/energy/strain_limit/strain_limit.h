#pragma once

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// Strain limit of C-IPC (docs/theory/method.md, section 5): a barrier on principal stretches above 1, +∞ at
/// the limit. Its bound energy has a max_step and a stretch_limit.
class StrainLimit final : public Energy {
 public:
  struct Parameters {
    double limit = 1.1;
    double stiffness = 1e3;
    static void declare(Declaration<Parameters>& d) {
      d.add("limit", &Parameters::limit)
          .unit("1")
          .at_least(1.0001)
          .at_most(100)
          .description("largest principal stretch s of every triangle, never reached")
          .source("our default; cotton 1.0608 and wool-lycra 1.134: Li et al. 2021");
      d.add("stiffness", &Parameters::stiffness)
          .unit("Pa")
          .at_least(1e-9)
          .at_most(bounds::largest_modulus)
          .description("κ_s, stiffness of the barrier: energy per volume")
          .source("Li et al. 2021, section 5");
    }
  };

  explicit StrainLimit(const Parameters& parameters) : p_(parameters) {}
  EnergyRole role() const override { return EnergyRole::limit; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;

 private:
  Parameters p_;
};

}  // namespace drape
