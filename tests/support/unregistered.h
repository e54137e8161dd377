#pragma once

#include "core/kernel/plugin/plugin.h"

// Energies and plugins that are defined, or included as sources, after this register nothing: a test sees
// their classes and laws, such as drape::formulas::stvk.

#define DRAPE_JOINED_(a, b) a##b
#define DRAPE_JOINED(a, b) DRAPE_JOINED_(a, b)
#undef DRAPE_PLUGIN
#define DRAPE_PLUGIN(registry) \
  [[maybe_unused]] static void DRAPE_JOINED(unregistered_, __COUNTER__)(drape::Registry & registry)
