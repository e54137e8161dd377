// A plugin whose entry function gives nothing.

#include "core/plugin/abi.h"

extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() {
  return nullptr;
}
