#include <algorithm>
#include <set>

#include "core/app/report/metric_columns.h"
#include "core/app/report/tables.h"
#include "core/app/view/html.h"

namespace drape {

namespace {

using html::Cell;
using html::escape;
using html::words;

using Row = std::vector<Cell>;

/// Methods with compared levels.
std::vector<const MethodRecord*> compared_methods(const RunData& run) {
  std::vector<const MethodRecord*> methods;
  for (const MethodRecord& method : run.methods)
    if (!method.consistency.empty()) methods.push_back(&method);
  return methods;
}

/// A method's value in each cell, the best one in bold.
void add_compared(Row& row, const std::vector<const MethodRecord*>& methods, const MetricColumn& column,
                  int coarse, int fine) {
  std::vector<const ConsistencyRecord*> records;
  for (const MethodRecord* method : methods)
    if (const ConsistencyRecord* pair = method->pair(coarse, fine)) records.push_back(pair);
  const OptionalNumber best = best_of(column, records);
  for (const MethodRecord* method : methods) {
    const ConsistencyRecord* pair = method->pair(coarse, fine);
    const OptionalNumber value = pair ? pair->metrics.of(column.name) : OptionalNumber();
    row.push_back({value_text(column, value), true, best && value && *value == *best});
  }
}

/// The score of the scene's initial state in place of the coarse states: one number if it is equal for all
/// methods as displayed, else the range.
std::string start_cell(const std::vector<const MethodRecord*>& methods, const MetricColumn& column,
                       int coarse, int fine) {
  std::set<double> values;
  for (const MethodRecord* method : methods)
    if (const ConsistencyRecord* pair = method->pair(coarse, fine))
      if (const OptionalNumber value = pair->of_start.of(column.name)) values.insert(*value);
  if (values.empty()) return value_text(column, {});
  const std::string low = value_text(column, *values.begin()), high = value_text(column, *values.rbegin());
  return low == high ? low : low + " … " + high;
}

}  // namespace

std::string consistency_table(const RunData& run) {
  const std::vector<const MethodRecord*> methods = compared_methods(run);
  const std::vector<MetricColumn> columns = run.columns(MetricScope::pair, Shown::tables);
  if (methods.empty() || columns.empty())
    return "<p class=\"absent\">No pair of levels has been compared in this run.</p>";
  Row head = {words("levels"), words("measure"), words("unit")};
  for (const MethodRecord* method : methods) head.push_back({escape(method->name)});
  head.push_back({"flat start"});
  std::vector<Row> body;
  for (const auto& [coarse, fine] : run.pairs()) {
    for (const MetricColumn& column : columns) {
      Row row;
      if (&column == &columns.front()) {
        row.push_back(words(std::to_string(coarse) + " → " + std::to_string(fine)));
        row.back().rows = static_cast<int>(columns.size());
      }
      row.push_back(words(label_html(column)));
      row.push_back(words(escape(column.unit)));
      add_compared(row, methods, column, coarse, fine);
      row.push_back({start_cell(methods, column, coarse, fine)});
      body.push_back(row);
    }
  }
  return html::table({head}, body);
}

std::string metric_texts(const RunData& run, MetricScope scope) {
  std::string text;
  for (const DeclaredMetric& metric : run.metrics) {
    const auto& columns = metric.declaration.columns;
    const bool shown = std::any_of(columns.begin(), columns.end(),
                                   [](const MetricColumn& c) { return c.shown >= Shown::tables; });
    if (metric.scope == scope && shown && !metric.declaration.text.empty())
      text += (text.empty() ? "" : " ") + html::formula(metric.declaration.text);
  }
  return text;
}

}  // namespace drape
