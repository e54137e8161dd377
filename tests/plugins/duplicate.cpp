// A plugin whose only fault is a name that good.cpp has too.

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"

namespace {

struct Duplicate final : drape::Refiner {
  drape::ProlongationMatrix weights(const drape::Level&) const override { return {}; }
};

}  // namespace

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, Duplicate>("good", "Another one of that name."); }
