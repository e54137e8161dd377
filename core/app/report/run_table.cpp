#include "core/app/report/run_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/app/experiment/exit_codes.h"
#include "core/app/report/compare.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/interfaces/solver.h"

namespace drape {

namespace {

/// A whole number, or null.
Json count_of(const OptionalNumber& number) { return number ? Json(std::llround(*number)) : Json(); }

/// What the iterations of a method tell beyond its levels. Shortened steps are counted as costs are, on the
/// levels that the last state builds on.
struct IterationSummary {
  OptionalNumber shortened_steps = 0.0;  // empty if iterations.csv lacks rows
  OptionalNumber smallest_gap, intersections;

  IterationSummary(const RunData& run, const MethodRecord& method) {
    const Csv& csv = run.iterations;
    double rows = 0;
    for (std::size_t k = 0; k < csv.size(); ++k) {
      if (csv.text(k, "method") != method.name) continue;
      const double level = csv.number(k, "level").value_or(0);
      const bool counts =
          level >= method.first_level() && !method.levels.empty() && level <= method.levels.back().level;
      rows += counts;
      *shortened_steps += counts && csv.number(k, "step_length").value_or(1) < 1;
      note(csv.number(k, "smallest_gap"), csv.number(k, "intersections"));
    }
    if (rows < method.cost("iterations").value_or(0)) shortened_steps.reset();
    for (const LevelRecord& level : method.levels)
      note(number_member(level.values, "smallest_gap"), number_member(level.values, "intersections"));
  }

  void note(const OptionalNumber& gap, const OptionalNumber& crossing) {
    if (gap) smallest_gap = std::min(smallest_gap.value_or(*gap), *gap);
    if (crossing) intersections = intersections.value_or(0) + *crossing;
  }
};

/// Whether the times of a method's levels tell of more than the method: the system had more running tasks
/// than processors, or not even one thread a processor of its own.
bool was_busy(const RunData& run, const MethodRecord& method) {
  const OptionalNumber processors = number_member(run.results, "machine.processors");
  for (const LevelRecord& level : method.levels) {
    const OptionalNumber cpu = number_member(level.values, "cpu_seconds"),
                         wall = number_member(level.values, "seconds");
    if (cpu && wall && *wall > 0.2 && *cpu < 0.9 * *wall) return true;
    for (const char* load : {"load_before", "load_after"})
      if (processors && number_member(level.values, load).value_or(0) > *processors + 0.5) return true;
  }
  return false;
}

/// The error of a method's final state, or of its preview, the last state of its coarsest level.
OptionalNumber last_error(const RunData& run, const MethodRecord& method, bool preview,
                          const std::string& column) {
  if (method.levels.empty() || (preview && method.levels.size() < 2)) return {};
  const int level = (preview ? method.levels.front() : method.levels.back()).level;
  OptionalNumber last;
  for (std::size_t k = 0; k < run.errors.size(); ++k)
    if (run.errors.text(k, "method") == method.name && run.errors.number(k, "level") == level)
      last = run.errors.number(k, column);
  return last;
}

std::string error_name(const ErrorMeasure& m) { return m.name == energy_gap ? m.name : "error_" + m.name; }

/// The statuses of the levels, or the one that all have; then the method's own if no level has it, as in an
/// aborted run.
std::string statuses(const MethodRecord& method) {
  std::vector<std::string> words;
  for (const LevelRecord& level : method.levels) words.push_back(level.status);
  if (!method.status.empty() && !is_one_of(method.status, words)) words.push_back(method.status);
  const bool same = std::ranges::count(words, method.status) == std::ssize(words);
  return same ? method.status : joined(words);
}

/// A metric's value of one method: of a state metric, that of the finest level, or for summaries the worst of
/// all levels; of a pair metric, that of the coarsest level against the finest.
OptionalNumber metric_value(const MetricColumn& column, MetricScope scope, const MethodRecord& method) {
  if (method.levels.empty()) return {};
  if (scope == MetricScope::state)
    return column.shown == Shown::summary ? worst_over_levels(column, method)
                                          : number_member(method.levels.back().values, column.name);
  for (const ConsistencyRecord& pair : method.consistency)
    if (pair.coarse == method.levels.front().level && pair.fine == method.levels.back().level)
      return number_member(pair.values, column.name);
  return {};
}

std::string status_without_results(const RunRecord& run) {
  if (run.status != "failed") return run.status;
  const bool has_begun = std::filesystem::exists(run.folder / "results.json");
  return run.exit_code == exit_bad_input && !has_begun ? "refused"
         : run.exit_code == exit_too_slow              ? "timeout"
         : run.exit_code > exit_by_signal              ? "crash"
                                                       : "failed";
}

/// Whether the energy of a method's last level is a number, but for its strain limit.
bool has_energy(const MethodRecord& method) {
  return !method.levels.empty() && number_member(method.levels.back().values, "energy_on_finest");
}

/// `is_measured`: the row is of a method that has_energy.
bool passes(const RunRecord& run, const std::string& status, const TableRow& row, bool is_measured) {
  if (!run.data && has_converged(status)) return false;  // its results are gone
  if (run.data && !is_measured) return false;
  if (number_member(row, "intersections").value_or(0) > 0) return false;
  const bool expected = status == run.expected || (run.expected == "converged" && has_converged(status));
  return expected && text_member(row, "message").find(run.expected_message) != std::string::npos;
}

}  // namespace

Json json_of(const OptionalNumber& number) { return number ? Json(*number) : Json(); }

std::vector<std::string> summary_quantities(const std::vector<ErrorMeasure>& measures) {
  std::vector<std::string> names = {"seconds", "iterations", "flops", "energy_released"}, previews;
  for (const ErrorMeasure& m : measures) {
    if (m.use < ErrorUse::summary) continue;
    names.push_back(error_name(m));
    previews.push_back("preview_" + m.name);
  }
  names.emplace_back("preview_seconds");
  names.insert(names.end(), previews.begin(), previews.end());
  return names;
}

TableRow row_of(const RunData& run, const MethodRecord& method) {
  const IterationSummary iterations(run, method);
  const bool several = method.levels.size() > 1;
  const Json none, &first = several ? method.levels.front().values : none,
                   &last = method.levels.empty() ? none : method.levels.back().values;
  std::string fault, remark;
  if (method.status == "running")
    fault = "if the run has ended, drape run --resume " + run.folder.string() + " goes on with it\n";
  for (const LevelRecord& level : method.levels)
    if (!level.message.empty())
      (has_converged(level.status) ? remark : fault) +=
          (several ? "level " + std::to_string(level.level) + ": " : "") + level.message + "\n";
  Json row = {
      {"method", method.name}, {"solver", method.solver}, {"pass", false}, {"status", statuses(method)}};
  row["stability"] = member_of(member_of(last, "stability"), "verdict");
  row["lowest_eigenvalue"] = json_of(number_member(last, "stability.lowest_eigenvalue"));
  row["curvature_ratio"] = json_of(number_member(last, "stability.curvature_ratio"));
  row["force_residual"] = json_of(number_member(last, "force_residual"));
  row["vertices"] = count_of(number_member(last, "vertices"));
  row["steps"] = count_of(method.cost("steps"));
  row["iterations"] = count_of(method.cost("iterations"));
  row["shortened_steps"] = count_of(iterations.shortened_steps);
  row["seconds"] = json_of(method.cost("seconds"));
  row["cpu_seconds"] = json_of(method.cost("cpu_seconds"));
  row["machine"] = was_busy(run, method) ? "busy" : "";
  row["flops"] = json_of(method.cost("flops"));
  row["energy_released"] = json_of(number_member(last, "energy_released"));
  row["smallest_gap"] = json_of(iterations.smallest_gap);
  row["intersections"] = count_of(iterations.intersections);
  row["preview_seconds"] = json_of(number_member(first, "seconds"));
  // The error of the reference against itself says nothing.
  const bool is_reference = run.reference == method.name;
  row["reference"] = is_reference;
  for (const ErrorMeasure& m : error_measures(run.metrics)) {
    if (m.use < ErrorUse::summary) continue;
    row[error_name(m)] =
        is_reference ? Json() : json_of(last_error(run, method, false, "reference_" + m.name));
    row["preview_" + m.name] = json_of(last_error(run, method, true, "own_" + m.name));
  }
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const MetricColumn& column : columns_of(run.metrics, scope, Shown::stored))
      if (!row.contains(column.name)) row[column.name] = json_of(metric_value(column, scope, method));
  fault += remark;
  row["message"] = fault.substr(0, fault.find('\n'));
  return row;
}

double rank_of(Better better, double value) {
  return better == Better::lower ? std::abs(value) : better == Better::higher ? -value : value;
}

OptionalNumber worst_over_levels(const MetricColumn& column, const MethodRecord& method) {
  OptionalNumber worst;
  for (const LevelRecord& level : method.levels) {
    const OptionalNumber value = number_member(level.values, column.name);
    if (value && (!worst || rank_of(column.better, *value) > rank_of(column.better, *worst))) worst = value;
  }
  return worst;
}

RunTable table_of(const RunCollection& collection) {
  RunTable table;
  for (const RunRecord& run : collection.runs)
    for (const auto& [key, value] : run.settings.items())
      if (key != "methods" && key != "start.seed") add_new(table.keys, key);  // these have own columns
  table.columns = {"sweep", "run"};
  table.columns.insert(table.columns.end(), table.keys.begin(), table.keys.end());
  table.columns.insert(table.columns.end(),
                       {"seed", "method", "pass", "status", "stability", "vertices", "steps", "iterations",
                        "shortened_steps", "seconds", "cpu_seconds", "machine", "energy_released",
                        "smallest_gap", "intersections", "force_residual"});
  const std::vector<DeclaredMetric> metrics = collection.metrics();
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const MetricColumn& column : columns_of(metrics, scope, Shown::summary))
      table.columns.push_back(column.name);
  const auto add_to_files = [&](const std::string& name) {
    if (is_one_of(name, table.columns)) return;
    table.columns.push_back(name);
    table.in_files.push_back(name);
  };
  for (const char* name : {"lowest_eigenvalue", "curvature_ratio"}) add_to_files(name);
  for (const std::string& name : summary_quantities(collection.error_measures())) add_to_files(name);
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const MetricColumn& column : columns_of(metrics, scope, Shown::stored)) add_to_files(column.name);
  table.columns.push_back("message");
  std::map<std::string, int> models;  // numbers of the physics that runs share
  for (const RunRecord& run : collection.runs) {
    Json name = {
        {"sweep", run.sweep}, {"run", run.name}, {"variation", run.variation}, {"seed", count_of(run.seed)}};
    if (run.data) name["physics"] = models.emplace(model_of(run.data->config), models.size()).first->second;
    for (const std::string& key : table.keys) {
      const Json& value = member_of(run.settings, key);
      name[key] = value.is_structured() ? Json(json_text(value)) : value;
    }
    const auto add = [&](const std::string& status, const Json& cells, bool is_measured = false) {
      TableRow& row = table.rows.emplace_back(name);
      row.update(cells);
      row["pass"] = passes(run, status, row, is_measured);
    };
    table.has_results = table.has_results || run.data;
    if (run.has_methods()) {
      for (const MethodRecord& method : run.data->methods)
        add(method.status, row_of(*run.data, method), has_energy(method));
    } else if (run.data) {
      const Json& cause = member_of(run.data->results, "aborted");
      add("",
          {{"method", ""},
           {"status", cause.is_null() ? "running" : "aborted"},
           {"message", cause.is_null() ? "no method has begun; if the run has ended, run it again" : cause}});
    } else {
      add(status_without_results(run),
          {{"method", ""}, {"status", status_without_results(run)}, {"message", run.error}});
    }
  }
  return table;
}

bool RunTable::all_pass() const {
  return std::all_of(rows.begin(), rows.end(), [](const TableRow& row) { return row["pass"].get<bool>(); });
}

}  // namespace drape
