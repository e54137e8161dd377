#include <algorithm>
#include <map>

#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment_path.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/interfaces/solver.h"

namespace drape {

namespace {

/// None for iterations: those of one method cost more than those of another.
std::optional<Better> better_of(const std::string& column, const std::vector<DeclaredMetric>& metrics) {
  if (column == "iterations") return {};
  if (column == "energy_released") return Better::higher;
  if (column == "cpu_seconds" || is_one_of(column, summary_quantities(error_measures(metrics))))
    return Better::lower;
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const MetricColumn& declared : columns_of(metrics, scope, Shown::stored))
      if (declared.name == column && declared.better != Better::neither) return declared.better;
  return {};
}

Json spread_of(std::vector<double> values) {
  if (values.empty()) return nullptr;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {{"median", (values[(n - 1) / 2] + values[n / 2]) / 2},
          {"low", values.front()},
          {"high", values.back()},
          {"count", n}};
}

/// Whether every level of a method has: levels that ended differently have a word each, as in "converged,
/// stalled".
bool all_converged(const std::string& status) {
  return std::ranges::all_of(split(status, ','), [](const std::string& word) {
    return has_converged(word.starts_with(' ') ? word.substr(1) : word);
  });
}

/// Names the column in the one row, if there is one, whose range is apart from those of all rivals, with
/// three digits too.
void mark_best(std::vector<TableRow*> rivals, const std::string& column, Better better) {
  std::erase_if(rivals, [&](const TableRow* row) { return !(*row)[column].is_object(); });
  const auto rank = [&](const TableRow* row, const char* end) {
    return rank_of(better, (*row)[column][end]);
  };
  const auto worst = [&](const TableRow* row) { return std::max(rank(row, "low"), rank(row, "high")); };
  const auto best = [&](const TableRow* row) {
    const bool around_zero =
        better == Better::lower && (*row)[column]["low"] <= 0 && (*row)[column]["high"] >= 0;
    return around_zero ? 0 : std::min(rank(row, "low"), rank(row, "high"));
  };
  const auto is_single = [&](const TableRow* row) { return (*row)[column]["count"] == 1; };
  if (rivals.size() < 2 || std::ranges::any_of(rivals, is_single)) return;  // a single value has no range
  for (TableRow* row : rivals)
    if (std::ranges::all_of(rivals, [&](const TableRow* other) {
          return other == row ||
                 (worst(row) < best(other) && number_text(worst(row)) != number_text(best(other)));
        }))
      (*row)["best"].push_back(column);
}

}  // namespace

std::vector<TableRow> summary_of(const RunTable& table, const std::vector<DeclaredMetric>& metrics) {
  std::vector<TableRow> summary;
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  std::vector<std::vector<const TableRow*>> starts;
  for (const TableRow& row : table.rows) {
    const auto [place, is_new] = places.emplace(std::pair(row["variation"], row["method"]), starts.size());
    if (is_new) starts.emplace_back();
    starts[place->second].push_back(&row);
  }
  std::vector<std::string> numbers;
  for (const std::string& column : table.columns)
    if (!is_one_of(column, table.keys) && column != "seed" &&
        std::ranges::any_of(table.rows,
                            [&](const TableRow& row) { return member_of(row, column).is_number(); }))
      numbers.push_back(column);
  for (const auto& rows : starts) {
    std::vector<const TableRow*> good = rows;
    std::erase_if(good, [](const TableRow* row) { return !all_converged(text_member(*row, "status")); });
    Json& entry = summary.emplace_back();
    for (const char* shared : {"sweep", "run", "variation", "method", "solver", "physics"})
      entry[shared] = member_of(*rows.front(), shared);
    for (const std::string& key : table.keys) entry[key] = (*rows.front())[key];
    entry["starts"] = rows.size();
    entry["converged"] = std::to_string(good.size()) + " of " + std::to_string(rows.size());
    const auto count = [&](const char* key, const Json& value) {
      return std::ranges::count_if(rows, [&](const auto* row) { return member_of(*row, key) == value; });
    };
    entry["reference"] = count("reference", true);
    entry["machine"] = count("machine", "busy") > 0 ? "busy" : "";
    entry["best"] = Json::array();
    for (const std::string& column : numbers) {
      std::vector<double> values;
      for (const TableRow* row : good)
        if (const auto value = number_member(*row, column)) values.push_back(*value);
      entry[column] = spread_of(std::move(values));
    }
  }
  std::map<Json, std::vector<TableRow*>> groups;
  for (TableRow& row : summary) groups[row["physics"]].push_back(&row);
  for (const auto& [physics, rows] : groups)
    for (const std::string& column : numbers)
      if (const auto better = better_of(column, metrics)) {
        std::vector<TableRow*> rivals = rows;
        // The reference is at no distance from itself by its definition.
        const bool to_reference = column == energy_gap || column.starts_with("error_");
        std::erase_if(rivals, [&](const TableRow* row) { return to_reference && (*row)["reference"] > 0; });
        mark_best(rivals, column, *better);
      }
  return summary;
}

Json table_json(const RunCollection& collection) {
  const RunTable table = table_of(collection);
  Json units = Json::object();
  for (const std::string& key : table.keys) units[key] = unit_of(key);
  const std::vector<DeclaredMetric> metrics = collection.metrics();
  Json metric_units = Json::object();
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const MetricColumn& column : columns_of(metrics, scope, Shown::stored))
      if (!column.unit.empty() && column.unit != "1") metric_units[column.name] = column.unit;
  return {{"columns", table.columns},
          {"rows", table.rows},
          {"units", units},
          {"metric_units", metric_units},
          {"summary", summary_of(table, metrics)},
          {"bold", bold_text}};
}

}  // namespace drape
