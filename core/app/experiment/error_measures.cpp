#include "core/app/experiment/error_measures.h"

#include <algorithm>

namespace drape {

std::vector<ErrorMeasure> error_measures(const std::vector<DeclaredMetric>& metrics) {
  std::vector<ErrorMeasure> measures;
  for (const MetricColumn& column : columns_of(metrics, MetricScope::pair, Shown::stored)) {
    const auto same = [&](const ErrorMeasure& m) { return m.name == column.error; };
    if (column.error.empty() || std::any_of(measures.begin(), measures.end(), same)) continue;
    const std::string label = (column.better == Better::higher ? "1 − " : "") + column.label +
                              (column.unit == "1" ? "" : " [" + column.unit + "]");
    measures.push_back({column.error, label, column.error_use, column.name, column.better});
  }
  std::stable_partition(measures.begin(), measures.end(),
                        [](const ErrorMeasure& m) { return m.use == ErrorUse::ranking; });
  measures.push_back(
      {energy_gap, "energy gap, over the energy released", ErrorUse::summary, "", Better::lower});
  return measures;
}

}  // namespace drape
