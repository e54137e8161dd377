// A plugin that loads: one refiner, which tells its parameter by the number of rows it returns.

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"

namespace {

struct Good final : drape::Refiner {
  int rows = 3;
  static void declare(drape::Declaration<Good>& d) {
    d.add("rows", &Good::rows, "rows of the returned matrix").at_least(1).source("test");
  }
  drape::ProlongationMatrix weights(const drape::Level&) const override { return {rows, 1}; }
};

}  // namespace

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, Good>("good", "A refiner that loads."); }
