// A plugin that names nothing.

#include "core/kernel/plugin/plugin.h"

DRAPE_PLUGIN(registry) { (void)registry; }
