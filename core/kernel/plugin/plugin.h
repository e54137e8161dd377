#pragma once

#include "core/kernel/plugin/abi.h"
#include "core/kernel/plugin/number_parameters.h"
#include "core/kernel/plugin/registry.h"

/// Registers a plugin library's entries, once per library:
///
///     DRAPE_PLUGIN(registry) {
///       registry.add<drape::Energy, Gravity>("gravity", "Weight of the cloth.");
///     }
///
/// It exports one C function, `drape_plugin`, whose descriptor is checked before any other call. The enum
/// tells by its name what a second one in a file is an error for.
#define DRAPE_PLUGIN(registry)                                                                    \
  enum class DRAPE_JOINED(drape_plugin, _macro_needs_a_file_of_its_own) {};                       \
  static void DRAPE_JOINED(drape_plugin, _entries)(drape::Registry & registry);                   \
  extern "C" __attribute__((visibility("default"))) const DrapePluginDescriptor* drape_plugin() { \
    static constexpr DrapePluginDescriptor descriptor =                                           \
        DRAPE_ABI_DESCRIPTOR(DRAPE_JOINED(drape_plugin, _entries));                               \
    return &descriptor;                                                                           \
  }                                                                                               \
  static void DRAPE_JOINED(drape_plugin, _entries)(drape::Registry & registry)
#define DRAPE_JOINED_(a, b) a##b
#define DRAPE_JOINED(a, b) DRAPE_JOINED_(a, b)
