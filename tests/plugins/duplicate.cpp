// A plugin whose only fault is a name that good.cpp has too.

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"

namespace {

class Duplicate final : public drape::Refiner {
 public:
  struct Parameters {
    static void declare(drape::Declaration<Parameters>&) {}
  };
  explicit Duplicate(const Parameters&) {}
  drape::ProlongationMatrix weights(const drape::Level&) const override { return {}; }
};

}  // namespace

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, Duplicate>("good", "Another one of that name."); }
