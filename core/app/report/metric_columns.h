#pragma once

#include <string>
#include <vector>

#include "core/app/report/run_data.h"

namespace drape {

// How reports show the columns that metrics declare.

/// The column's label as HTML; without one, its name.
std::string label_html(const MetricColumn& column);
/// The label with the unit, for the head of a table.
std::string title_html(const MetricColumn& column);
/// A value of the column, with its number of decimals, or a dash.
std::string value_text(const MetricColumn& column, const OptionalNumber& value);

/// The worst of a state metric's values over a method's levels: where neither direction is better, the
/// largest.
OptionalNumber worst_over_levels(const MetricColumn& column, const MethodRecord& method);

/// The best value of a pair column among methods for one pair of levels. Absent unless at least two values
/// are known and the best one beats that of the scene's initial state: a flat cloth must not win.
OptionalNumber best_of(const MetricColumn& column, const std::vector<const ConsistencyRecord*>& records);

}  // namespace drape
