// A plugin that throws while it is registered.

#include <stdexcept>

#include "core/kernel/plugin/plugin.h"

DRAPE_PLUGIN(registry) {
  (void)registry;
  throw std::logic_error("out of luck");
}
