#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/plugin.h"

namespace {

/// How high and how low a state reaches.
struct Height : drape::Metric {
  drape::MetricDeclaration declaration() const override {
    using drape::Better;
    return {
        .columns = {{.name = "lowest", .label = "lowest point", .unit = "m", .better = Better::neither},
                    {.name = "highest", .label = "highest point", .unit = "m", .better = Better::neither}}};
  }

  drape::MetricResult measure(const drape::MetricInput& input) const override {
    const auto z = input.x.col(2);
    return {{{"lowest", z.minCoeff()}, {"highest", z.maxCoeff()}}, {}};
  }
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, Height>("height", "Lowest and highest point of a state.");
}
