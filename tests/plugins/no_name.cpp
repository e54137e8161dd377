// A plugin with a refiner that has no name.

#include "tests/plugins/refiner.h"

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, RefinerOfRows>("", "A refiner without a name."); }
