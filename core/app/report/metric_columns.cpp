#include "core/app/report/metric_columns.h"

#include "core/app/view/html.h"

namespace drape {

std::string label_html(const MetricColumn& column) {
  return column.label.empty() ? html::escape(column.name) : html::formula(column.label);
}

std::string title_html(const MetricColumn& column) {
  const bool has_unit = !column.unit.empty() && column.unit != "1";
  return label_html(column) + (has_unit ? " [" + html::escape(column.unit) + "]" : "");
}

std::string value_text(const MetricColumn& column, const OptionalNumber& value) {
  return column.decimals < 0 ? html::number_text(value) : html::fixed(value, column.decimals);
}

OptionalNumber worst_over_levels(const MetricColumn& column, const MethodRecord& method) {
  OptionalNumber worst;
  for (const LevelRecord& level : method.levels) {
    const OptionalNumber value = level.metrics.of(column.name);
    if (!value) continue;
    const bool worse =
        !worst || (column.better == Better::neither ? *value > *worst : beats(column.better, *worst, *value));
    if (worse) worst = value;
  }
  return worst;
}

OptionalNumber best_of(const MetricColumn& column, const std::vector<const ConsistencyRecord*>& records) {
  const ConsistencyRecord* best = nullptr;
  OptionalNumber best_value;
  int known = 0;
  for (const ConsistencyRecord* record : records) {
    const OptionalNumber value = record->metrics.of(column.name);
    if (!value) continue;
    ++known;
    if (!best || beats(column.better, *value, *best_value)) best = record, best_value = value;
  }
  if (known < 2 || column.better == Better::neither) return {};
  const OptionalNumber start = best->of_start.of(column.name);  // unknown for runs of earlier versions
  if (start && !beats(column.better, *best_value, *start)) return {};
  return best_value;
}

}  // namespace drape
