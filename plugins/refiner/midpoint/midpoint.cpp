#include "plugins/refiner/midpoint/midpoint.h"

#include "core/kernel/plugin/plugin.h"

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, drape::MidpointRefiner>(
      "midpoint", "Midpoint subdivision: every triangle is split into four; the surface does not move.");
}
