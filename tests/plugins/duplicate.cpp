// A plugin whose only fault is a name that good.cpp has too.

#include "tests/plugins/refiner.h"

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, RefinerOfRows>("good", "Another of that name."); }
