// A plugin that loads.

#include "tests/plugins/refiner.h"

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, RefinerOfRows>("good", "A refiner that loads."); }
