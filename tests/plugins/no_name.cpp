// A plugin with a refiner that has no name.

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"

namespace {

struct Nameless final : drape::Refiner {
  drape::ProlongationMatrix weights(const drape::Level&) const override { return {}; }
};

}  // namespace

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, Nameless>("", "A refiner without a name."); }
