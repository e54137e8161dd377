#include "core/app/report/chart_data.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/app/view/colours.h"
#include "core/app/view/html.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_points = 500;  // per series; more are not visible

/// Energies are comparable only within the same objective: a level's plain energy, or its proxy (the finest
/// level has none).
bool is_proxy(const RunData& run, const IterationSeries& series, const RecordedIteration& row) {
  return row.proxy_energy && series.level != run.finest_level();
}

OptionalNumber objective(const RunData& run, const IterationSeries& series, const RecordedIteration& row) {
  return is_proxy(run, series, row) ? row.proxy_energy : finite(row.energy);
}

/// Root mean square length of the Newton direction over the vertices [m]. A static step has no h; its
/// decrement was computed with the first one.
OptionalNumber newton_step(const RunData& run, const IterationSeries& series, const RecordedIteration& row) {
  OptionalNumber h = finite(row.step_size);
  for (const MethodRecord& method : run.methods) {
    if (!h && method.name == series.method) h = method.step_size;
  }
  return h ? finite(*h * row.decrement) : OptionalNumber();
}

Json series_json(const RunData& run) {
  std::map<std::pair<int, bool>, double> best;
  for (const IterationSeries& series : run.iterations) {
    for (const RecordedIteration& row : series.rows) {
      const OptionalNumber energy = objective(run, series, row);
      if (!energy) continue;
      const auto key = std::pair(series.level, is_proxy(run, series, row));
      const auto known = best.emplace(key, *energy).first;
      known->second = std::min(known->second, *energy);
    }
  }
  Json all = Json::array();
  for (const IterationSeries& series : run.iterations) {
    Json iteration = Json::array(), seconds = iteration, residual = iteration, step = iteration,
         gap = iteration;
    const std::size_t count = series.rows.size(), stride = (count + most_points - 1) / most_points;
    for (std::size_t k = 0; k < count; ++k) {
      if (k % stride != 0 && k + 1 != count) continue;
      const RecordedIteration& row = series.rows[k];
      const OptionalNumber energy = objective(run, series, row);
      iteration.push_back(k + 1);
      seconds.push_back(rounded(finite(row.seconds)));
      residual.push_back(rounded(finite(row.force_residual)));
      step.push_back(rounded(newton_step(run, series, row)));
      gap.push_back(energy ? rounded(*energy - best.at({series.level, is_proxy(run, series, row)})) : Json());
    }
    all.push_back({{"method", series.method},
                   {"level", series.level},
                   {"iteration", iteration},
                   {"seconds", seconds},
                   {"force_residual", residual},
                   {"step", step},
                   {"gap", gap}});
  }
  return all;
}

/// Bars: one label per level and method, one row of values per name.
Json bars_json(const RunData& run, NamedNumbers LevelRecord::*member) {
  Json labels = Json::array();
  std::vector<std::string> names;
  std::vector<std::map<std::string, OptionalNumber>> columns;
  for (const MethodRecord& method : run.methods) {
    for (const LevelRecord& level : method.levels) {
      if ((level.*member).empty()) continue;
      labels.push_back(method.name + ", level " + std::to_string(level.level));
      columns.emplace_back();
      for (const auto& [name, value] : level.*member) {
        columns.back()[name] = value;
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    }
  }
  Json values = Json::array();
  for (const std::string& name : names) {
    Json row = Json::array();
    for (const auto& column : columns) {
      row.push_back(column.count(name) ? rounded(column.at(name)) : Json());
    }
    values.push_back(row);
  }
  return {{"labels", labels}, {"names", names}, {"values", values}};
}

/// Whether the method's last state builds on the level.
bool contributes_to_final_state(const RunData& run, const ErrorSeries& series) {
  for (const MethodRecord& method : run.methods)
    if (method.name == series.method) return series.level >= method.first_level();
  return true;
}

Json errors_json(const RunData& run) {
  Json all = Json::array();
  for (const ErrorSeries& series : run.errors) {
    if (!contributes_to_final_state(run, series)) continue;
    Json entry = {{"method", series.method}, {"level", series.level}};
    for (std::size_t w = 0; w < error_costs.size(); ++w)
      for (const ErrorRow& row : series.rows) entry[error_costs[w]].push_back(rounded(row.cost[w]));
    for (std::size_t t = 0; t < error_targets.size(); ++t)
      for (const ErrorMeasure& m : run.error_measures)
        for (const ErrorRow& row : series.rows)
          entry[error_targets[t]][m.name].push_back(rounded(row.error[t].of(m.name)));
    all.push_back(entry);
  }
  return all;
}

Json increments_json(const RunData& run) {
  Json all = Json::array();
  for (const IncrementSeries& series : run.increments) {
    Json time = Json::array(), steps = time, released = time;
    for (const IncrementRecord& row : series.rows) {
      time.push_back(rounded(row.time));
      steps.push_back(rounded(row.steps));
      released.push_back(rounded(row.energy_released));
    }
    all.push_back({{"method", series.method},
                   {"level", series.level},
                   {"time", time},
                   {"steps", steps},
                   {"energy_released", released}});
  }
  return all;
}

}  // namespace

Json rounded(const OptionalNumber& value) {
  if (!value) return nullptr;
  return parse_number(general_text(*value, 6)).value();
}

Json method_json(const std::string& name, const std::string& solver) {
  return {{"name", name}, {"style", solver_style(solver)}};
}

Json measures_json(const std::vector<ErrorMeasure>& measures) {
  Json all = Json::array();
  for (const ErrorMeasure& m : measures) all.push_back({{"name", m.name}, {"label", m.label}});
  return all;
}

std::string chart_data(const RunData& run) {
  Json methods = Json::array();
  for (const MethodRecord& method : run.methods) methods.push_back(method_json(method.name, method.solver));
  const Json data = {{"methods", methods},
                     {"coarsest", run.coarsest_level()},
                     {"finest", run.finest_level()},
                     {"tolerance", rounded(run.force_tolerance)},
                     {"series", series_json(run)},
                     {"measures", measures_json(run.error_measures)},
                     {"errors", errors_json(run)},
                     {"increments", increments_json(run)},
                     {"phases", bars_json(run, &LevelRecord::seconds_by_phase)},
                     {"parts", bars_json(run, &LevelRecord::energy_parts_released)}};
  return html::script_json(data);
}

}  // namespace drape
