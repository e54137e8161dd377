#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/app/report/metric_columns.h"
#include "core/app/report/tables.h"
#include "core/app/view/html.h"

namespace drape {

namespace {

using html::escape;
using html::number_text;

/// "0.001", where a measured number would be "1.00e-3".
std::string shortest(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// The method whose coarsest and finest levels agree best by a column, if several have them and the flat
/// initial state would not score as well.
std::string most_consistent(const RunData& run, const MetricColumn& column) {
  const auto pairs = run.pairs();
  if (pairs.empty()) return "";
  const int coarse = pairs.front().first, fine = pairs.back().second;
  std::vector<const ConsistencyRecord*> records;
  for (const MethodRecord& method : run.methods)
    if (const ConsistencyRecord* pair = method.pair(coarse, fine)) records.push_back(pair);
  const OptionalNumber best_value = best_of(column, records);
  if (!best_value) return "";
  const auto best = std::find_if(run.methods.begin(), run.methods.end(), [&](const MethodRecord& method) {
    const ConsistencyRecord* pair = method.pair(coarse, fine);
    return pair && pair->metrics.of(column.name) == best_value;
  });
  return "; from level " + std::to_string(coarse) + " to " + std::to_string(fine) + ", <b>" +
         escape(best->name) + "</b> " + html::formula(column.best) + " (" + label_html(column) + " = " +
         value_text(column, best_value) + ")";
}

/// "1 pair" or "3 pairs".
std::string counted(double number, const std::string& thing) {
  return std::to_string(std::llround(number)) + " " + thing + (number == 1 ? "" : "s");
}

/// Checked states of a run: those of levels, and of iterations if every step is checked.
struct Audit {
  int levels = 0, iterations = 0;
  std::string found;  ///< intersecting states
  OptionalNumber smallest_gap;

  void gap(const OptionalNumber& gap) {
    if (gap) smallest_gap = std::min(smallest_gap.value_or(*gap), *gap);
  }
  void note(const std::string& method, int level, const std::string& what) {
    found += (found.empty() ? "" : "; ") + method + ", level " + std::to_string(level) + ": " + what;
  }
};

void audit_levels(const RunData& run, Audit& audit) {
  for (const MethodRecord& method : run.methods) {
    for (const LevelRecord& level : method.levels) {
      audit.gap(level.smallest_gap);
      if (!level.intersections) continue;
      ++audit.levels;
      if (*level.intersections > 0)
        audit.note(method.name, level.level, counted(*level.intersections, "intersecting pair"));
    }
  }
}

void audit_iterations(const RunData& run, Audit& audit) {
  for (const IterationSeries& series : run.iterations) {
    int crossing = 0;
    for (const RecordedIteration& row : series.rows) {
      audit.gap(row.smallest_gap);
      audit.iterations += row.intersections.has_value();
      crossing += row.intersections.value_or(0) > 0;
    }
    if (crossing > 0)
      audit.note(series.method, series.level, "intersections in " + counted(crossing, "iteration"));
  }
}

}  // namespace

std::optional<Verdict> intersection_verdict(const RunData& run) {
  Audit audit;
  audit_levels(run, audit);
  audit_iterations(run, audit);
  if (audit.levels + audit.iterations == 0) return {};
  if (!audit.found.empty())
    return Verdict{false, "Intersections: " + audit.found + ". log.jsonl names the first ones."};
  std::string text = "No intersection at any recorded state (" + counted(audit.levels, "level");
  if (audit.iterations > 0) text += " and " + counted(audit.iterations, "iteration");
  text += " checked";
  if (audit.smallest_gap) text += ", smallest gap on the way " + number_text(audit.smallest_gap) + " m";
  return Verdict{true, text + ")."};
}

std::string troubles(const RunData& run) {
  std::string items, remarks, on_input;
  for (const std::string& line : run.remarks) on_input += "<li>" + escape(line) + "</li>\n";
  for (const MethodRecord& method : run.methods) {
    for (const LevelRecord& level : method.levels) {
      const std::string where =
          "<li><b>" + escape(method.name) + "</b>, level " + std::to_string(level.level);
      const std::string message = level.message.empty() ? "" : ": " + escape(level.message);
      if (level.status == "failed")
        items += where + ": failed" + message + "</li>\n";
      else if (!has_converged(level.status) && !level.status.empty())
        items += where + ": " + escape(level.status) + " after " + html::count(level.iterations) +
                 " iterations at force residual " + number_text(level.force_residual) + message + "</li>\n";
      else if (!message.empty())
        remarks += where + message + "</li>\n";
    }
  }
  const auto list = [](const std::string& title, const std::string& rows) {
    return rows.empty() ? "" : "<p>" + title + "</p>\n<ul>\n" + rows + "</ul>\n";
  };
  return list("What did not converge:", items) + list("Remarks on what converged:", remarks) +
         list("Remarks on the input:", on_input);
}

OptionalNumber energy_released(const MethodRecord& method) {
  return method.levels.empty() ? OptionalNumber() : method.levels.back().energy_released;
}

namespace {

std::string energy_words(double released, double most) {
  if (released == most) return "released the most energy";
  if (most <= 0) return "released " + number_text(most - released) + "&nbsp;J less energy";
  const double percent = 100 * (most - released) / most;
  return percent < 0.1 ? "released the most energy to within 0.1&nbsp;%"
                       : "released " + number_text(percent) + "&nbsp;% less energy";
}

}  // namespace

std::string method_verdict(const RunData& run, const MethodRecord& method) {
  if (method.status == "failed") return "failed; below is why, and its figures are of the levels before that";
  if (!has_converged(method.status)) return "did not converge; its figures are of where it stopped";
  OptionalNumber fastest, most, best_preview;
  int compared = 0;
  const auto preview = [&](const MethodRecord& m) {
    return m.levels.size() > 1 ? m.levels.front().energy_released : OptionalNumber();
  };
  const auto higher = [](OptionalNumber& best, const OptionalNumber& value) {
    if (value) best = std::max(best.value_or(*value), *value);
  };
  for (const MethodRecord& m : run.methods) {
    if (!has_converged(m.status)) continue;
    ++compared;
    if (const OptionalNumber seconds = m.cost(&LevelRecord::seconds))
      fastest = std::min(fastest.value_or(*seconds), *seconds);
    higher(most, energy_released(m));
    higher(best_preview, preview(m));
  }
  if (compared < 2) return "converged; nothing to compare it with";
  const OptionalNumber seconds = method.cost(&LevelRecord::seconds), released = energy_released(method);
  std::string text;
  if (seconds && *fastest > 0)
    text = *seconds == *fastest ? "fastest" : number_text(*seconds / *fastest) + "× the fastest's time";
  if (released) text += (text.empty() ? "" : "; ") + energy_words(*released, *most);
  if (best_preview && preview(method) == best_preview) text += "; best preview";
  return text;
}

std::string outcome_sentence(const RunData& run) {
  if (run.methods.empty()) return "The run holds no method's results yet.";
  int converged = 0;
  bool to_rounding = false;
  for (const MethodRecord& m : run.methods) {
    converged += has_converged(m.status);
    to_rounding = to_rounding || m.status == to_string(Outcome::converged_to_rounding);
  }
  const int total = static_cast<int>(run.methods.size());
  std::string text = run.complete          ? ""
                     : run.aborted.empty() ? "The run is not complete; these are the figures it had written. "
                                           : "The run was aborted (" + escape(run.aborted) +
                                                 "); these are the figures it had written. ";
  text += std::to_string(converged) + " of " + std::to_string(total) + (total == 1 ? " method" : " methods") +
          " converged";
  if (run.force_tolerance)
    text += " (force residual below " + shortest(*run.force_tolerance) +
            (to_rounding ? ", or as low as rounding allows)" : ")");

  const MethodRecord* lowest = nullptr;
  std::string others;
  for (const MethodRecord& m : run.methods)
    if (has_converged(m.status) && energy_released(m) &&
        (!lowest || *energy_released(m) > *energy_released(*lowest)))
      lowest = &m;
  for (const MethodRecord& m : run.methods)
    if (&m != lowest && has_converged(m.status) && energy_released(m))
      others += ", " + escape(m.name) + " " + number_text(*energy_released(*lowest) - *energy_released(m)) +
                " J less";
  if (!others.empty())
    text += "; <b>" + escape(lowest->name) + "</b> ends with the lowest energy (it released " +
            number_text(energy_released(*lowest)) + " J" + others + ")";
  for (const MetricColumn& column : run.columns(MetricScope::pair, Shown::tables))
    if (!column.best.empty()) text += most_consistent(run, column);
  return text + ".";
}

}  // namespace drape
