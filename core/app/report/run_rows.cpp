#include "core/app/report/run_rows.h"

#include <algorithm>
#include <functional>

#include "core/app/report/pair_measures.h"
#include "core/app/report/tables.h"

namespace drape {

namespace {

constexpr std::size_t own = 0, reference = 1;                // targets
constexpr std::size_t rms = 0, d_H_fit = 2, energy_gap = 4;  // measures

const ErrorRow* last_error(const RunData& run, const MethodRecord& method, bool preview) {
  if (method.levels.empty() || (preview && method.levels.size() < 2)) return nullptr;
  const int level = (preview ? method.levels.front() : method.levels.back()).level;
  for (const ErrorSeries& series : run.errors)
    if (series.method == method.name && series.level == level && !series.rows.empty())
      return &series.rows.back();
  return nullptr;
}

template <bool preview, std::size_t target, std::size_t measure>
OptionalNumber error_of(const RunData& run, const MethodRecord& method) {
  const ErrorRow* row = last_error(run, method, preview);
  return row ? row->error[target][measure] : OptionalNumber();
}

OptionalNumber seconds(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::seconds); }
OptionalNumber iterations(const RunData&, const MethodRecord& m) {
  return m.cost(&LevelRecord::newton_iterations);
}
OptionalNumber flops(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::flops); }
OptionalNumber preview_seconds(const RunData&, const MethodRecord& m) {
  return m.levels.size() > 1 ? m.levels.front().seconds : OptionalNumber();
}

}  // namespace

std::string RunRow::title(bool several_variations) const {
  return several_variations ? variation + ", " + method : method;
}

const std::vector<RowQuantity>& row_quantities() {
  static const std::vector<RowQuantity> all = {
      {"seconds", "time [s]", seconds},
      {"iterations", "iterations", iterations},
      {"flops", "flops", flops},
      {"energy", "final energy [J]", final_energy},
      {"energy_gap", "energy gap", error_of<false, reference, energy_gap>},
      {"error_rms", "error, RMS", error_of<false, reference, rms>},
      {"error_d_H_fit", "error, d<sub>H</sub><sup>fit</sup>", error_of<false, reference, d_H_fit>},
      {"preview_seconds", "preview after [s]", preview_seconds},
      {"preview_rms", "preview's own error, RMS", error_of<true, own, rms>},
      {"preview_d_H_fit", "preview's own d<sub>H</sub><sup>fit</sup>", error_of<true, own, d_H_fit>},
      {"preview_energy_gap", "preview's own energy gap", error_of<true, own, energy_gap>}};
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
                                   std::size_t target, std::size_t measure) {
  int begin = 0;
  for (const MethodRecord& m : run.methods)
    if (m.name == method)
      for (const LevelRecord& level : m.levels)
        if (level.from_initial_state) begin = level.level;
  std::vector<CostPoint> curve;
  for (const ErrorSeries& series : run.errors) {
    if (series.method != method || series.level < begin) continue;
    for (const ErrorRow& row : series.rows)
      if (row.cost[cost] && row.error[target][measure])
        curve.push_back({*row.cost[cost], *row.error[target][measure]});
  }
  return curve;
}

RunData median_consistency(const RunCollection& collection, const std::string& variation) {
  RunData medians;
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
      for (const PairMeasure& measure : pair_measures) {
        std::vector<double> values, of_start;
        for (const ConsistencyRecord* r : records) {
          if (const OptionalNumber& value = r->*measure.value) values.push_back(*value);
          if (const OptionalNumber& value = r->of_start.*measure.value) of_start.push_back(*value);
        }
        if (const auto spread = spread_of(values)) pair.*measure.value = spread->median;
        if (const auto spread = spread_of(of_start)) pair.of_start.*measure.value = spread->median;
      }
    }
  }
  return medians;
}

}  // namespace drape
