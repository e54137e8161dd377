#include "core/app/report/undeclared_metrics.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

namespace drape {

namespace {

using Json = nlohmann::ordered_json;

/// Numbers of a level and of a pair of levels that are no metric's.
constexpr std::string_view own_numbers[] = {
    "level",          "vertices", "triangles",      "steps",         "newton_iterations", "factorisations",
    "flops",          "analyses", "seconds",        "energy",        "energy_on_finest",  "decrement",
    "coarse",         "fine",     "force_residual", "intersections", "smallest_gap",      "mesh_checksum",
    "fields_checksum"};

void add_columns(std::vector<MetricColumn>& columns, const Json& entry) {
  if (!entry.is_object()) return;
  for (const auto& [name, value] : entry.items()) {
    const auto known = [&n = name](const MetricColumn& c) { return c.name == n; };
    if (!value.is_number() ||
        std::find(std::begin(own_numbers), std::end(own_numbers), name) != std::end(own_numbers) ||
        std::any_of(columns.begin(), columns.end(), known))
      continue;
    columns.push_back({.name = name, .better = Better::neither});
  }
}

void add_columns_of_all(std::vector<MetricColumn>& columns, const Json& method, const char* list) {
  if (!method.is_object() || !method.contains(list) || !method[list].is_array()) return;
  for (const Json& entry : method[list]) add_columns(columns, entry);
}

}  // namespace

std::vector<DeclaredMetric> undeclared_metrics(const Json& methods) {
  DeclaredMetric states{"state", MetricScope::state, {}}, pairs{"pair", MetricScope::pair, {}};
  if (methods.is_object())
    for (const auto& [name, method] : methods.items()) {
      add_columns_of_all(states.declaration.columns, method, "levels");
      add_columns_of_all(pairs.declaration.columns, method, "consistency");
    }
  return {states, pairs};
}

std::vector<ErrorMeasure> undeclared_errors(const Csv& errors) {
  const std::string target = std::string(error_targets.front()) + "_";
  std::vector<ErrorMeasure> measures;
  for (const std::string& column : errors.names())
    if (column.starts_with(target)) {
      const std::string name = column.substr(target.size());
      if (name == energy_gap)
        measures.push_back(error_measures({}).back());
      else
        measures.push_back({name, name, ErrorUse::plots, name, Better::lower});
    }
  return measures;
}

}  // namespace drape
