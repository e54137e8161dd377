#include "plugins/refiner/midpoint/midpoint.h"

#include "core/plugin/plugin.h"

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, drape::MidpointRefiner>(
      "midpoint", "Midpoint subdivision: every triangle is split in four and the surface stays where it is.");
}
