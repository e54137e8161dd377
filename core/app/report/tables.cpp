#include "core/app/report/tables.h"

#include <algorithm>

#include "core/app/report/metric_columns.h"
#include "core/app/view/html.h"

namespace drape {

namespace {

using html::Cell;
using html::escape;
using html::number_text;
using html::words;

using Row = std::vector<Cell>;

std::string status_badge(const std::string& status) {
  const std::string kind = has_converged(status) ? "good" : status.empty() ? "none" : "poor";
  std::string text;
  for (const char c : status.empty() ? "–" : escape(status)) {
    text += c;
    if (c == '_') text += "<wbr>";  // a narrow table breaks long ones there
  }
  return "<span class=\"status " + kind + "\">" + text + "</span>";
}

Cell head_of(const char* name) { return html::head(level_quantity(name).title, name); }

/// Contact quantities of a state; empty without contact.
void add_contact_head(Row& head, const RunData& run) {
  if (!run.has_contact()) return;
  head.push_back({"contacts"});
  for (const char* name : {"smallest_gap", "intersections"}) head.push_back(head_of(name));
}

void add_contact_cells(Row& row, const RunData& run, const LevelRecord& r) {
  if (!run.has_contact()) return;
  row.push_back({html::count(r.contacts)});
  row.push_back({number_text(r.smallest_gap)});
  row.push_back({html::count(r.intersections), true, r.intersections.value_or(0) > 0});
}

/// Values of state metrics.
void add_metric_head(Row& head, const std::vector<MetricColumn>& columns) {
  for (const MetricColumn& column : columns) head.push_back(html::head(title_html(column), column.name));
}

void add_metric_cells(Row& row, const std::vector<MetricColumn>& columns, const LevelRecord& r) {
  for (const MetricColumn& column : columns) row.push_back({value_text(column, r.metrics.of(column.name))});
}

}  // namespace

std::string summary_table(const RunData& run) {
  Row head = {words("method"), words("status"), words("verdict"), {"levels"}};
  for (const char* name : {"seconds", "steps", "iterations", "energy_released"})
    head.push_back(head_of(name));
  head.push_back({"above lowest [J]"});
  for (const char* name : {"force_residual", "decrement"}) head.push_back(head_of(name));
  const std::vector<MetricColumn> columns = run.columns(MetricScope::state, Shown::summary);
  add_metric_head(head, columns);
  add_contact_head(head, run);
  head.push_back({"peak memory"});
  OptionalNumber most;
  for (const MethodRecord& method : run.methods)
    if (const OptionalNumber released = energy_released(method))
      most = std::max(most.value_or(*released), *released);
  std::vector<Row> body;
  for (const MethodRecord& method : run.methods) {
    const OptionalNumber released = energy_released(method);
    const LevelRecord none, &last = method.levels.empty() ? none : method.levels.back();
    const OptionalNumber seconds = method.seconds ? method.seconds : method.sum(&LevelRecord::seconds);
    Row row = {words(escape(method.name)),
               words(status_badge(method.status)),
               words("<span class=\"verdict\">" + method_verdict(run, method) + "</span>"),
               {std::to_string(method.levels.size())},
               {number_text(seconds)},
               {html::count(method.sum(&LevelRecord::steps))},
               {html::count(method.sum(&LevelRecord::iterations))},
               {number_text(released)},
               {number_text(released ? OptionalNumber(*most - *released) : released)},
               {number_text(last.force_residual)},
               {number_text(last.decrement)}};
    add_metric_cells(row, columns, last);
    add_contact_cells(row, run, last);
    row.push_back({html::bytes(method.peak_memory_bytes)});
    body.push_back(row);
  }
  return html::table({head}, body);
}

std::string level_table(const RunData& run) {
  constexpr const char* quantities[] = {"vertices", "triangles",       "steps",          "iterations",
                                        "seconds",  "energy_released", "force_residual", "decrement"};
  Row head = {words("method"), {"level"}, words("status")};
  for (const char* name : quantities) head.push_back(head_of(name));
  const std::vector<MetricColumn> columns = run.columns(MetricScope::state, Shown::tables);
  add_metric_head(head, columns);
  add_contact_head(head, run);
  std::vector<Row> body;
  for (const MethodRecord& method : run.methods) {
    for (const LevelRecord& r : method.levels) {
      Row row;
      if (&r == &method.levels.front()) {
        row.push_back(words(escape(method.name)));
        row.back().rows = static_cast<int>(method.levels.size());
      }
      row.push_back({std::to_string(r.level)});
      row.push_back(words(status_badge(r.status)));
      for (const char* name : quantities) {
        const LevelQuantity& quantity = level_quantity(name);
        const OptionalNumber& value = r.*quantity.member;
        row.push_back({quantity.count ? html::count(value) : number_text(value)});
      }
      add_metric_cells(row, columns, r);
      add_contact_cells(row, run, r);
      body.push_back(row);
    }
  }
  return html::table({head}, body);
}

}  // namespace drape
