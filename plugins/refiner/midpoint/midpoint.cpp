#include "core/numerics/hierarchy/midpoint.h"

#include "core/kernel/plugin/plugin.h"

namespace drape {

/// Midpoint subdivision: splits every triangle into four and does not move the surface.
class MidpointRefiner : public Refiner {
 public:
  ProlongationMatrix weights(const Level& coarse) const override { return midpoint_weights(coarse); }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, drape::MidpointRefiner>(
      "midpoint", "Midpoint subdivision: every triangle is split into four; the surface does not move.");
}
