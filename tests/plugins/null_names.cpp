// A plugin whose descriptor has null for its build.

#include "core/kernel/plugin/abi.h"

extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() {
  static constexpr DrapePluginDescriptor descriptor = {DRAPE_ABI_MAGIC, DRAPE_ABI_NUMBER, nullptr, nullptr};
  return &descriptor;
}
