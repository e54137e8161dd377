#include <stdexcept>

#include "core/kernel/model/level_model.h"
#include "core/kernel/model/metric.h"
#include "core/kernel/plugin/plugin.h"

namespace drape {

/// How much higher another state lies than the end, in the plain energy of the end's level without contact.
class EnergyAboveEnd : public Metric {
 public:
  struct Parameters {
    static void declare(Declaration<Parameters>&) {}
  };
  explicit EnergyAboveEnd(const Parameters&) {}

  MetricScope scope() const override { return MetricScope::pair; }

  MetricResult evaluate(const MetricInput& input) const override {
    if (!input.other)
      throw std::runtime_error("energy_above_end compares two states of one level, but was given one");
    const double above =
        input.model.energy_without_contact(*input.other) - input.model.energy_without_contact(input.x);
    return {{{"energy_above_end", above, "J", Better::lower}}, {}};
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::EnergyAboveEnd>(
      "energy_above_end", "How much higher in energy a state lies than the one that it is compared with.");
}
