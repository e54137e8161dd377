// A plugin that throws while the library is loaded, before drape can call it.

#include <stdexcept>

#include "core/kernel/plugin/plugin.h"

namespace {

int unlucky() { throw std::runtime_error("out of luck"); }

[[maybe_unused]] const int number = unlucky();

}  // namespace

DRAPE_PLUGIN(registry) { (void)registry; }
