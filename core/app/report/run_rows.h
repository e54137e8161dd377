#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/app/report/run_collection.h"
#include "core/app/report/statistics.h"

namespace drape {

/// A method of a run.
struct Repeat {
  const RunRecord* run;
  const MethodRecord* method;
};

/// One method under one variation, with its repeats over seeds.
struct RunRow {
  std::string variation, method;
  std::vector<Repeat> repeats;  ///< those with results
  int converged = 0;

  std::string title(bool several_variations) const;
};

/// Rows by variation, then method, in order of appearance.
std::vector<RunRow> rows_of(const RunCollection& collection);

/// A quantity of a row, by the name that tables and comparisons use.
struct RowQuantity {
  std::string name;   ///< "seconds"
  std::string title;  ///< HTML
  std::function<OptionalNumber(const RunData& run, const MethodRecord& method)> of;
};

/// Cost and quality of a method's final state and of its preview, the last state of its coarsest level: those
/// that every run has, then the errors that are measured.
std::vector<RowQuantity> row_quantities(const std::vector<ErrorMeasure>& measures);

/// Whether the run's reference is the method's own final state, whose error says nothing.
bool is_own_reference(const RunData& run, const MethodRecord& method);

/// The quantity that is a measure's error of the final state against the reference. Absent where that is the
/// method's own.
std::string error_name(const ErrorMeasure& measure);
/// The quantity that is a measure's error of the preview against the method's own final state.
std::string preview_name(const ErrorMeasure& measure);

/// Median and range over the repeats that converged.
std::optional<Spread> spread_of(const RunRow& row, const RowQuantity& quantity);

/// Error over cost in one measure, for the states of the levels that a method's last state builds on.
std::vector<CostPoint> error_curve(const RunData& run, const std::string& method, std::size_t cost,
                                   std::size_t target, const std::string& measure);

/// A run with the medians of a variation's pair metrics.
RunData median_consistency(const RunCollection& collection, const std::string& variation);

/// HTML: medians and ranges per row, with a verdict relative to the first variation or row.
std::string rows_table(const RunCollection& collection);
/// HTML: failed and missing runs with their errors; empty without any.
std::string failures_table(const RunCollection& collection);
/// In words: the numbers of runs and the best rows.
std::string collection_summary(const RunCollection& collection);
/// The data of the page's charts, as JSON.
std::string rows_chart_data(const RunCollection& collection);

}  // namespace drape
