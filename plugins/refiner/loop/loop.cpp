#include "plugins/refiner/loop/loop.h"

#include "core/kernel/plugin/plugin.h"

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, drape::LoopRefiner>(
      "loop", "Loop subdivision with B-spline borders and interpolated corners: smooth; the surface moves.");
}
