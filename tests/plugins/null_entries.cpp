// A plugin of this very build, but without the function that names its entries.

#include "core/kernel/plugin/abi.h"

extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() {
  static constexpr DrapePluginDescriptor descriptor = DRAPE_ABI_DESCRIPTOR(nullptr);
  return &descriptor;
}
