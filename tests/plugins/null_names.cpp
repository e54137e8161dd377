// A plugin whose descriptor has null for every text.

#include "core/kernel/plugin/abi.h"

extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() {
  static constexpr DrapePluginDescriptor descriptor = {
      DRAPE_ABI_MAGIC, DRAPE_ABI_NUMBER, nullptr, nullptr, nullptr, EIGEN_MAX_ALIGN_BYTES, nullptr, nullptr};
  return &descriptor;
}
