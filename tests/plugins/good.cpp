// A plugin that loads: one refiner, which tells its parameter by the number of rows it returns.

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"

namespace {

class Good final : public drape::Refiner {
 public:
  struct Parameters {
    int rows = 3;
    static void declare(drape::Declaration<Parameters>& d) {
      d.add("rows", &Parameters::rows).at_least(1).description("rows of the returned matrix").source("test");
    }
  };
  explicit Good(const Parameters& p) : rows_(p.rows) {}
  drape::ProlongationMatrix weights(const drape::Level&) const override { return {rows_, 1}; }

 private:
  int rows_;
};

}  // namespace

DRAPE_PLUGIN(registry) { registry.add<drape::Refiner, Good>("good", "A refiner that loads."); }
