#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/model/level_model.h"

namespace drape {

/// The plain energy of a state, term by term.
class EnergyByPart : public Metric {
 public:
  /// Reports show the energies that the run itself records.
  MetricDeclaration declaration() const override {
    return {.columns = {
                {.name = "energy", .unit = "J", .shown = Shown::stored},
                {.name = "energy_parts", .label = "energy of a part", .unit = "J", .shown = Shown::stored}}};
  }

 private:
  MetricResult measure(const MetricInput& input) const override {
    MetricResult result;
    for (const auto& [name, joules] : input.model.energy_parts(input.x))
      result.values.push_back({"energy_parts." + name, joules});
    result.values.push_back({"energy", input.model.energy(input.x)});
    return result;
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::EnergyByPart>("energy", "Plain energy of a state, in all and by term.");
}
