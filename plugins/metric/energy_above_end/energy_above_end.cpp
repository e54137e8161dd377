#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/model/level_model.h"

namespace drape {

/// How much higher another state lies than the end, in the plain energy of the end's level without contact.
class EnergyAboveEnd : public Metric {
 public:
  MetricScope scope() const override { return MetricScope::pair; }

  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "energy_above_end", .label = "energy above the end", .unit = "J"}},
            .text =
                "Energy above the end is the fine level's energy, without contact, at the prolonged state "
                "less that at the fine one; a dash means that the prolonged state violates the strain "
                "limit."};
  }

 private:
  MetricResult measure(const MetricInput& input) const override {
    const double above =
        input.model.energy_without_contact(*input.other) - input.model.energy_without_contact(input.x);
    return {{{"energy_above_end", above}}, {}};
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::EnergyAboveEnd>(
      "energy_above_end", "How much higher in energy a state lies than the one that it is compared with.");
}
