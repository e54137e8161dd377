// A plugin whose entry function gives nothing.

#include "core/kernel/plugin/abi.h"

extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() {
  return nullptr;
}
