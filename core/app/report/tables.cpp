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

/// Contact quantities of a state; empty without contact.
void add_contact_head(Row& head, const RunData& run) {
  if (!run.has_contact()) return;
  for (const char* title : {"contacts", "smallest gap [m]", "intersections"}) head.push_back({title});
}

void add_contact_cells(Row& row, const RunData& run, const LevelRecord& r) {
  if (!run.has_contact()) return;
  row.push_back({html::count(r.contacts)});
  row.push_back({number_text(r.smallest_gap)});
  row.push_back({html::count(r.intersections), true, r.intersections.value_or(0) > 0});
}

/// Values of state metrics.
void add_metric_head(Row& head, const std::vector<MetricColumn>& columns) {
  for (const MetricColumn& column : columns) head.push_back({title_html(column)});
}

void add_metric_cells(Row& row, const std::vector<MetricColumn>& columns, const LevelRecord& r) {
  for (const MetricColumn& column : columns) row.push_back({value_text(column, r.metrics.of(column.name))});
}

/// Names of all energy parts, in order of first appearance.
std::vector<std::string> part_names(const RunData& run) {
  std::vector<std::string> names;
  for (const MethodRecord& method : run.methods) {
    for (const LevelRecord& level : method.levels) {
      for (const auto& [name, value] : level.energy_parts) {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    }
  }
  return names;
}

}  // namespace

std::string summary_table(const RunData& run) {
  Row head = {words("method"),      words("status"),    words("verdict"),      {"levels"},
              {"time [s]"},         {"steps"},          {"Newton iterations"}, {"final energy [J]"},
              {"above lowest [J]"}, {"force residual"}, {"decrement [m/s]"}};
  const std::vector<MetricColumn> columns = run.columns(MetricScope::state, Shown::summary);
  add_metric_head(head, columns);
  add_contact_head(head, run);
  head.push_back({"peak memory"});
  OptionalNumber lowest;
  for (const MethodRecord& method : run.methods) {
    const OptionalNumber energy = final_energy(run, method);
    if (energy) lowest = std::min(lowest.value_or(*energy), *energy);
  }
  std::vector<Row> body;
  for (const MethodRecord& method : run.methods) {
    const OptionalNumber energy = final_energy(run, method);
    const LevelRecord none, &last = method.levels.empty() ? none : method.levels.back();
    const OptionalNumber seconds = method.seconds ? method.seconds : method.sum(&LevelRecord::seconds);
    Row row = {words(escape(method.name)),
               words(status_badge(method.status)),
               words("<span class=\"verdict\">" + method_verdict(run, method) + "</span>"),
               {std::to_string(method.levels.size())},
               {number_text(seconds)},
               {html::count(method.sum(&LevelRecord::steps))},
               {html::count(method.sum(&LevelRecord::newton_iterations))},
               {number_text(energy)},
               {number_text(energy ? OptionalNumber(*energy - *lowest) : energy)},
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
  Row head = {words("method"), {"level"},         {"vertices"},          {"triangles"},
              words("status"), {"steps"},         {"Newton iterations"}, {"time [s]"},
              {"energy [J]"},  {"on finest [J]"}, {"force residual"},    {"decrement [m/s]"}};
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
      const Row rest = {
          {std::to_string(r.level)},       {html::count(r.vertices)}, {html::count(r.triangles)},
          words(status_badge(r.status)),   {html::count(r.steps)},    {html::count(r.newton_iterations)},
          {number_text(r.seconds)},        {number_text(r.energy)},   {number_text(r.energy_on_finest)},
          {number_text(r.force_residual)}, {number_text(r.decrement)}};
      row.insert(row.end(), rest.begin(), rest.end());
      add_metric_cells(row, columns, r);
      add_contact_cells(row, run, r);
      body.push_back(row);
    }
  }
  return html::table({head}, body);
}

std::string energy_table(const RunData& run) {
  const std::vector<std::string> names = part_names(run);
  if (names.empty()) return "<p class=\"absent\">No energy parts were recorded.</p>";
  Row head = {words("method"), {"level"}};
  for (const std::string& name : names) head.push_back({escape(name)});
  head.push_back({"sum"});
  std::vector<Row> body;
  for (const MethodRecord& method : run.methods) {
    for (const LevelRecord& level : method.levels) {
      Row row;
      if (&level == &method.levels.front()) {
        row.push_back(words(escape(method.name)));
        row.back().rows = static_cast<int>(method.levels.size());
      }
      row.push_back({std::to_string(level.level)});
      for (const std::string& name : names) {
        const auto part = std::find_if(level.energy_parts.begin(), level.energy_parts.end(),
                                       [&](const auto& p) { return p.first == name; });
        row.push_back({number_text(part == level.energy_parts.end() ? OptionalNumber() : part->second)});
      }
      row.push_back({number_text(level.energy)});
      body.push_back(row);
    }
  }
  return html::table({head}, body);
}

}  // namespace drape
