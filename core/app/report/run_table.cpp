#include "core/app/report/run_table.h"

#include <algorithm>

#include "core/app/experiment/exit_codes.h"
#include "core/app/report/metric_columns.h"
#include "core/app/report/tables.h"
#include "core/app/view/html.h"
#include "core/kernel/plugin/string_utils.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const OptionalNumber& number) { return number ? Json(*number) : Json(); }

/// What the iterations of a method tell beyond its levels. Shortened steps are counted as costs are, on the
/// levels that the last state builds on.
struct IterationSummary {
  OptionalNumber shortened_steps = 0.0;  // empty if steps.csv lacks rows
  OptionalNumber smallest_gap, intersections;

  IterationSummary(const RunData& run, const MethodRecord& method) {
    double rows = 0;
    for (const IterationSeries& series : run.iterations) {
      if (series.method != method.name) continue;
      const bool counts = series.level >= method.first_level();
      for (const StepRow& row : series.rows) {
        rows += counts;
        *shortened_steps += counts && row.step_length.value_or(1) < 1;
        if (row.smallest_gap)
          smallest_gap = std::min(smallest_gap.value_or(*row.smallest_gap), *row.smallest_gap);
        if (row.intersections) intersections = intersections.value_or(0) + *row.intersections;
      }
    }
    if (rows < method.cost(&LevelRecord::newton_iterations).value_or(0)) shortened_steps.reset();
  }
};

/// The outcomes of the levels, or the one that all have.
std::string outcomes(const MethodRecord& method) {
  std::vector<std::string> words;
  for (const LevelRecord& level : method.levels) words.push_back(level.status);
  const bool same =
      std::all_of(words.begin(), words.end(), [&](const auto& w) { return w == method.status; });
  return same ? method.status : joined(words);
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// A metric's value of one method: of a state metric, the worst of its levels'; of a pair metric, that of the
/// coarsest level against the finest.
OptionalNumber metric_value(const MetricColumn& column, MetricScope scope, const MethodRecord& method) {
  if (scope == MetricScope::state) return worst_over_levels(column, method);
  if (method.levels.size() < 2) return {};
  const ConsistencyRecord* pair = method.pair(method.levels.front().level, method.levels.back().level);
  return pair ? pair->metrics.of(column.name) : OptionalNumber();
}

Json row_of(const RunData& run, const MethodRecord& method) {
  IterationSummary iterations(run, method);
  std::string fault, remark;
  for (const LevelRecord& level : method.levels) {
    if (level.smallest_gap)
      iterations.smallest_gap =
          std::min(iterations.smallest_gap.value_or(*level.smallest_gap), *level.smallest_gap);
    if (level.intersections)
      iterations.intersections = iterations.intersections.value_or(0) + *level.intersections;
    if (level.message.empty()) continue;
    (has_converged(level.status) ? remark : fault) +=
        (method.levels.size() > 1 ? "level " + std::to_string(level.level) + ": " : "") + level.message +
        "\n";
  }
  Json row = {{"method", method.name}, {"pass", false}, {"outcome", outcomes(method)}};
  row["vertices"] = method.levels.empty() ? Json() : json_of(method.levels.back().vertices);
  row["steps"] = json_of(method.cost(&LevelRecord::steps));
  row["iterations"] = json_of(method.cost(&LevelRecord::newton_iterations));
  row["shortened_steps"] = json_of(iterations.shortened_steps);
  row["seconds"] = json_of(method.cost(&LevelRecord::seconds));
  row["energy"] = json_of(final_energy(run, method));
  row["smallest_gap"] = json_of(iterations.smallest_gap);
  row["intersections"] = json_of(iterations.intersections);
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const MetricColumn& column : run.columns(scope, Shown::summary))
      row[column.name] = json_of(metric_value(column, scope, method));
  row["message"] = first_line(fault + remark);
  return row;
}

std::string outcome_without_results(const RunRecord& run) {
  if (run.status != "failed") return run.status;
  return run.refused()                    ? "refused"
         : run.exit_code == exit_too_slow ? "timeout"
         : run.exit_code > exit_by_signal ? "crash"
                                          : "failed";
}

bool passes(const RunRecord& run, const std::string& outcome, const TableRow& row) {
  const Json energy = row.value("energy", Json()), crossing = row.value("intersections", Json());
  if (!run.data && has_converged(outcome)) return false;  // its results are gone
  if (run.data && (energy.is_null() || (crossing.is_number() && crossing.get<double>() > 0))) return false;
  const bool expected = outcome == run.expected || (run.expected == "converged" && has_converged(outcome));
  return expected && row.value("message", "").find(run.expected_message) != std::string::npos;
}

}  // namespace

RunTable table_of(const RunCollection& collection) {
  RunTable table;
  table.columns = {"sweep",        "run",        "method",          "pass",    "outcome", "vertices",
                   "steps",        "iterations", "shortened_steps", "seconds", "energy",  "smallest_gap",
                   "intersections"};
  const std::vector<DeclaredMetric> metrics = collection.metrics();
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const MetricColumn& column : columns_of(metrics, scope, Shown::summary))
      table.columns.push_back(column.name);
  table.columns.push_back("message");
  for (const RunRecord& run : collection.runs) {
    const bool repeated = collection.of(run.variation).size() > 1 && run.seed;
    const Json name = {{"sweep", run.sweep},
                       {"run", run.name + (repeated ? ", seed " + html::fixed(run.seed, 0) : "")}};
    const auto add = [&](const std::string& outcome, const Json& cells) {
      TableRow row = name;
      row.update(cells);
      row["pass"] = passes(run, outcome, row);
      table.rows.push_back(row);
    };
    table.has_results = table.has_results || run.data;
    if (run.data)
      for (const MethodRecord& method : run.data->methods) add(method.status, row_of(*run.data, method));
    else
      add(outcome_without_results(run), {{"method", ""},
                                         {"pass", false},
                                         {"outcome", outcome_without_results(run)},
                                         {"message", run.error}});
  }
  return table;
}

bool RunTable::all_pass() const {
  return std::all_of(rows.begin(), rows.end(), [](const TableRow& row) { return row["pass"].get<bool>(); });
}

}  // namespace drape
