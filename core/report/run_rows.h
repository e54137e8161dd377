#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/report/run_collection.h"
#include "core/report/statistics.h"

namespace drape {

/// A method of a run.
struct Repeat {
  const RunRecord* run;
  const MethodRecord* method;
};

/// One method under one variation, with its repeats over seeds.
struct RunRow {
  std::string variation, method;
  std::vector<Repeat> repeats;  ///< all that have results
  int converged = 0;

  std::string title(bool several_variations) const;
};

/// Rows by variation, then method, in order of appearance.
std::vector<RunRow> rows_of(const RunCollection& collection);

/// A figure of a row, as the tables and comparisons name it.
struct RowQuantity {
  const char* name;   ///< "seconds"
  const char* title;  ///< HTML
  OptionalNumber (*of)(const RunData& run, const MethodRecord& method);
};

/// What a method's final state cost and is worth, and its preview: the last state of its coarsest level.
const std::vector<RowQuantity>& row_quantities();

/// Of the repeats that converged.
std::optional<Spread> spread_of(const RunRow& row, const RowQuantity& quantity);

/// The states on the way to a method's last one, in one measure: those of the levels that it builds on.
std::vector<CostPoint> error_curve(const RunData& run, const std::string& method, std::size_t cost,
                                   std::size_t target, std::size_t measure);

/// A run whose consistency measures are the medians over the runs of a variation.
RunData median_consistency(const RunCollection& collection, const std::string& variation);

/// HTML: medians and ranges a row, with a verdict beside the first variation's, or the first row's.
std::string rows_table(const RunCollection& collection);
/// HTML: what failed or is missing, with its error; empty without any.
std::string failures_table(const RunCollection& collection);
/// In words: how many runs of what, and which row did best in what.
std::string collection_summary(const RunCollection& collection);
/// What the page draws.
std::string rows_chart_data(const RunCollection& collection);

}  // namespace drape
