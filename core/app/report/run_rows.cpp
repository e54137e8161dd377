#include "core/app/report/run_rows.h"

namespace drape {

namespace {

constexpr std::size_t own = 0, reference = 1;  // targets

/// Whether the run's reference is the method's own final state, whose error says nothing.
bool is_own_reference(const RunData& run, const MethodRecord& method) {
  return !run.reference_is_file && run.reference == method.name;
}

/// The quantity that is a measure's error of the final state against the reference.
std::string error_name(const ErrorMeasure& measure) {
  return measure.name == energy_gap ? measure.name : "error_" + measure.name;
}
/// The quantity that is a measure's error of the preview against the method's own final state.
std::string preview_name(const ErrorMeasure& measure) { return "preview_" + measure.name; }

const ErrorRow* last_error(const RunData& run, const MethodRecord& method, bool preview) {
  if (method.levels.empty() || (preview && method.levels.size() < 2)) return nullptr;
  const int level = (preview ? method.levels.front() : method.levels.back()).level;
  for (const ErrorSeries& series : run.errors)
    if (series.method == method.name && series.level == level && !series.rows.empty())
      return &series.rows.back();
  return nullptr;
}

RowQuantity error_quantity(const std::string& name, bool preview, std::size_t target,
                           const std::string& measure) {
  return {name, [=](const RunData& run, const MethodRecord& method) {
            if (target == reference && is_own_reference(run, method)) return OptionalNumber();
            const ErrorRow* row = last_error(run, method, preview);
            return row ? row->error[target].of(measure) : OptionalNumber();
          }};
}

OptionalNumber seconds(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::seconds); }
OptionalNumber iterations(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::iterations); }
OptionalNumber flops(const RunData&, const MethodRecord& m) { return m.cost(&LevelRecord::flops); }
OptionalNumber released(const RunData&, const MethodRecord& m) {
  return m.levels.empty() ? OptionalNumber() : m.levels.back().energy_released;
}
OptionalNumber preview_seconds(const RunData&, const MethodRecord& m) {
  return m.levels.size() > 1 ? m.levels.front().seconds : OptionalNumber();
}

}  // namespace

std::vector<RowQuantity> row_quantities(const std::vector<ErrorMeasure>& measures) {
  std::vector<RowQuantity> all = {
      {"seconds", seconds}, {"iterations", iterations}, {"flops", flops}, {"energy_released", released}};
  std::vector<ErrorMeasure> shown;
  for (const ErrorMeasure& m : measures)
    if (m.use >= ErrorUse::summary) shown.push_back(m);
  for (const ErrorMeasure& m : shown) all.push_back(error_quantity(error_name(m), false, reference, m.name));
  all.push_back({"preview_seconds", preview_seconds});
  for (const ErrorMeasure& m : shown) all.push_back(error_quantity(preview_name(m), true, own, m.name));
  return all;
}

}  // namespace drape
