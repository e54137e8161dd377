// A plugin as another compiler and another Eigen would have made it. Registering it must never happen.

#include <cstdlib>

#include "core/kernel/plugin/abi.h"

extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() {
  static constexpr DrapePluginDescriptor descriptor = {
      DRAPE_ABI_MAGIC, DRAPE_ABI_NUMBER, "GCC 4.8, Eigen 3.3.9", [](drape::Registry&) { std::abort(); }};
  return &descriptor;
}
