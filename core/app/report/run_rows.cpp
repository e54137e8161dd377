#include "core/app/report/run_rows.h"

#include <algorithm>
#include <map>

#include "core/app/report/tables.h"
#include "core/app/view/html.h"

namespace drape {

namespace {

constexpr std::size_t own = 0, reference = 1;  // targets

const ErrorRow* last_error(const RunData& run, const MethodRecord& method, bool preview) {
  if (method.levels.empty() || (preview && method.levels.size() < 2)) return nullptr;
  const int level = (preview ? method.levels.front() : method.levels.back()).level;
  for (const ErrorSeries& series : run.errors)
    if (series.method == method.name && series.level == level && !series.rows.empty())
      return &series.rows.back();
  return nullptr;
}

RowQuantity error_quantity(const std::string& name, const std::string& title, bool preview,
                           std::size_t target, const std::string& measure) {
  return {name, title, [=](const RunData& run, const MethodRecord& method) {
            if (target == reference && is_own_reference(run, method)) return OptionalNumber();
            const ErrorRow* row = last_error(run, method, preview);
            return row ? row->error[target].of(measure) : OptionalNumber();
          }};
}

OptionalNumber seconds(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::seconds); }
OptionalNumber iterations(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::iterations); }
OptionalNumber flops(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::flops); }
OptionalNumber released(const RunData&, const MethodRecord& m) { return energy_released(m); }
OptionalNumber preview_seconds(const RunData&, const MethodRecord& m) {
  return m.levels.size() > 1 ? m.levels.front().seconds : OptionalNumber();
}

}  // namespace

std::string error_name(const ErrorMeasure& measure) {
  return measure.name == energy_gap ? measure.name : "error_" + measure.name;
}

bool is_own_reference(const RunData& run, const MethodRecord& method) {
  return !run.reference_is_file && run.reference == method.name;
}

std::string preview_name(const ErrorMeasure& measure) { return "preview_" + measure.name; }

std::string RunRow::title(bool several_variations) const {
  return several_variations ? variation + ", " + method : method;
}

std::vector<RowQuantity> row_quantities(const std::vector<ErrorMeasure>& measures) {
  std::vector<RowQuantity> all = {{"seconds", "time [s]", seconds},
                                  {"iterations", "iterations", iterations},
                                  {"flops", "flops", flops},
                                  {"energy_released", "energy released [J]", released}};
  std::vector<ErrorMeasure> shown;
  for (const ErrorMeasure& m : measures)
    if (m.use >= ErrorUse::summary) shown.push_back(m);
  for (const ErrorMeasure& m : shown)
    all.push_back(
        error_quantity(error_name(m), "error: " + html::formula(m.label), false, reference, m.name));
  all.push_back({"preview_seconds", "preview after [s]", preview_seconds});
  for (const ErrorMeasure& m : shown)
    all.push_back(
        error_quantity(preview_name(m), "preview's own error: " + html::formula(m.label), true, own, m.name));
  return all;
}

std::vector<RunRow> rows_of(const RunCollection& collection) {
  std::vector<RunRow> rows;
  for (const std::string& variation : collection.variations())
    for (const std::string& method : collection.methods()) {
      RunRow row{variation, method, {}, 0};
      for (const RunRecord* run : collection.of(variation)) {
        if (!run->data) continue;
        for (const MethodRecord& m : run->data->methods)
          if (m.name == method) {
            row.repeats.push_back({run, &m});
            row.converged += has_converged(m.status);
          }
      }
      if (!row.repeats.empty()) rows.push_back(std::move(row));
    }
  return rows;
}

std::optional<Spread> spread_of(const RunRow& row, const RowQuantity& quantity) {
  std::vector<double> values;
  for (const Repeat& repeat : row.repeats)
    if (has_converged(repeat.method->status))
      if (const OptionalNumber value = quantity.of(*repeat.run->data, *repeat.method))
        values.push_back(*value);
  return spread_of(std::move(values));
}

std::vector<CostPoint> error_curve(const RunData& run, const std::string& method, std::size_t cost,
                                   std::size_t target, const std::string& measure) {
  int begin = 0;
  for (const MethodRecord& m : run.methods)
    if (m.name == method) begin = m.first_level();
  std::vector<CostPoint> curve;
  for (const ErrorSeries& series : run.errors) {
    if (series.method != method || series.level < begin) continue;
    for (const ErrorRow& row : series.rows)
      if (const OptionalNumber error = row.error[target].of(measure); error && row.cost[cost])
        curve.push_back({*row.cost[cost], *error});
  }
  return curve;
}

RunData median_consistency(const RunCollection& collection, const std::string& variation) {
  RunData medians;
  for (const RunRecord* run : collection.of(variation))
    if (run->data) merge(medians.metrics, run->data->metrics);
  for (const RunRow& row : rows_of(collection)) {
    if (row.variation != variation) continue;
    MethodRecord& method = medians.methods.emplace_back();
    method.name = row.method;
    std::map<std::pair<int, int>, std::vector<const ConsistencyRecord*>> repeats;
    for (const Repeat& repeat : row.repeats)
      for (const ConsistencyRecord& pair : repeat.method->consistency)
        repeats[{pair.coarse, pair.fine}].push_back(&pair);
    for (const auto& [levels, records] : repeats) {
      ConsistencyRecord& pair = method.consistency.emplace_back();
      pair.coarse = levels.first, pair.fine = levels.second;
      std::map<std::string, std::vector<double>> values, of_start;
      for (const ConsistencyRecord* r : records) {
        for (const auto& [name, value] : r->metrics) values[name].push_back(value);
        for (const auto& [name, value] : r->of_start) of_start[name].push_back(value);
      }
      for (const auto& [name, all] : values) pair.metrics.set(name, spread_of(all)->median);
      for (const auto& [name, all] : of_start) pair.of_start.set(name, spread_of(all)->median);
    }
  }
  return medians;
}

}  // namespace drape
