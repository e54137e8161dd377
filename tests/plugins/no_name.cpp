// A plugin with a refiner that has no name.

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"

namespace {

class Nameless final : public drape::Refiner {
 public:
  struct Parameters {
    static void declare(drape::Declaration<Parameters>&) {}
  };
  explicit Nameless(const Parameters&) {}
  drape::ProlongationMatrix weights(const drape::Level&) const override { return {}; }
};

}  // namespace

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, Nameless>("", "A refiner without a name."); }
