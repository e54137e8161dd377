#pragma once

#include "core/numerics/hierarchy/midpoint.h"

namespace drape {

/// Midpoint subdivision: splits every triangle into four and does not move the surface.
class MidpointRefiner : public Refiner {
 public:
  ProlongationMatrix weights(const Level& coarse) const override { return midpoint_weights(coarse); }
};

}  // namespace drape
