// A plugin as another compiler and another Eigen would have made it. Registering it must never happen.

#include <cstdlib>

#include "core/kernel/plugin/abi.h"

extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() {
  static constexpr DrapePluginDescriptor descriptor = {
      DRAPE_ABI_MAGIC, DRAPE_ABI_NUMBER,      "GCC 4.8", DRAPE_STANDARD_LIBRARY,
      "3.3.9",         EIGEN_MAX_ALIGN_BYTES, "double",  [](drape::Registry&) { std::abort(); }};
  return &descriptor;
}
