// A plugin that names nothing.

#include "core/plugin/plugin.h"

DRAPE_PLUGIN(registry) { (void)registry; }
