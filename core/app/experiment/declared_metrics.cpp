#include "core/app/experiment/declared_metrics.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "core/app/files/json_file.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

// The words of enumerations in results.json; an unknown word is read as the first.
NLOHMANN_JSON_SERIALIZE_ENUM(MetricScope, {{MetricScope::pair, "pair"}, {MetricScope::state, "state"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Better, {{Better::neither, "neither"},
                                      {Better::lower, "lower"},
                                      {Better::higher, "higher"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Shown, {{Shown::tables, "tables"},
                                     {Shown::stored, "stored"},
                                     {Shown::summary, "summary"}})
NLOHMANN_JSON_SERIALIZE_ENUM(ErrorUse, {{ErrorUse::plots, "plots"},
                                        {ErrorUse::summary, "summary"},
                                        {ErrorUse::ranking, "ranking"}})

namespace {

Json column_json(const MetricColumn& c) {
  Json json = {
      {"name", c.name}, {"label", c.label}, {"unit", c.unit}, {"better", c.better}, {"shown", c.shown}};
  if (c.error.empty()) return json;
  json["error"] = c.error;
  json["error_use"] = c.error_use;
  return json;
}

MetricColumn column_of(const Json& json) {
  MetricColumn c;
  c.name = text_member(json, "name");
  c.label = text_member(json, "label");
  c.unit = text_member(json, "unit");
  member_of(json, "better").get_to(c.better);
  member_of(json, "shown").get_to(c.shown);
  c.error = text_member(json, "error");
  member_of(json, "error_use").get_to(c.error_use);
  return c;
}

template <class Named>
void add_new(std::vector<Named>& all, const Named& one) {
  if (std::ranges::find(all, one.name, &Named::name) == all.end()) all.push_back(one);
}

}  // namespace

std::vector<std::string> default_metrics(const Registry& registry) {
  std::vector<std::string> names;
  for (const RegistryEntry* entry : registry.of_kind(Metric::kind))
    if (std::ranges::none_of(entry->schema.parameters, &Parameter::required)) names.push_back(entry->name);
  return names;
}

std::vector<DeclaredMetric> declared_metrics(
    const std::vector<std::pair<std::string, std::shared_ptr<Metric>>>& metrics) {
  std::vector<DeclaredMetric> declared;
  for (const auto& [name, metric] : metrics)
    add_new(declared, DeclaredMetric{name, metric->scope(), metric->declaration()});
  for (DeclaredMetric& metric : declared)
    for (MetricColumn& column : metric.declaration.columns)
      if (column.label.empty())
        std::ranges::replace_copy(column.name, std::back_inserter(column.label), '_', ' ');
  return declared;
}

void check_declarations(const std::vector<DeclaredMetric>& metrics, const Location& where,
                        ConfigErrors& errors) {
  // Keys of a level and of a pair of levels. The metric `energy` measures what
  // the first has under its names.
  static const auto of_level = split(
      "level vertices triangles status message steps iterations from_initial_state factorisations flops "
      "analyses seconds cpu_seconds load_before load_after seconds_by_phase energy energy_parts "
      "energy_on_finest energy_released "
      "energy_parts_released decrement force_residual intersections smallest_gap contact_stiffness mesh "
      "mesh_checksum snapshots not_measured",
      ' ');
  static const auto of_pair = split("coarse fine fields fields_checksum of_start against not_measured", ' ');
  std::map<std::pair<MetricScope, std::string>, std::string> owners;
  std::map<std::string, std::string> measures = {{energy_gap, "the run itself"}};  // of errors.csv, by whom
  std::map<std::string, std::string> fields;                                       // of fields/, by whom
  for (const DeclaredMetric& metric : metrics) {
    const auto refuse = [&](const std::string& what) {
      errors.push_back({where, "metric " + metric.name + ": " + what});
    };
    for (const MetricColours& colours : metric.declaration.colours)
      for (const std::string& field : {colours.field, colours.other_field})
        if (const auto [owner, is_new] = fields.insert({field, metric.name});
            owner->second != metric.name && !field.empty())
          refuse("the field \"" + field + "\" needs another name: metric " + owner->second +
                 " has one of it");
    const std::vector<std::string>& taken = metric.scope == MetricScope::state ? of_level : of_pair;
    for (const MetricColumn& column : metric.declaration.columns) {
      const std::string value = "the value \"" + column.name + "\"",
                        first = column.name.substr(0, column.name.find('.'));
      const auto [owner, is_new] = owners.insert({{metric.scope, column.name}, metric.name});
      if (column.name.empty())
        refuse("a value needs a name");
      else if (is_one_of(first, taken) && metric.name != "energy")
        refuse(value + " needs another name: results.json has a key \"" + first + "\" of its own");
      else if (!is_new)
        refuse(value + (owner->second == metric.name ? " is declared twice"
                                                     : " is declared by metric " + owner->second + " too"));
      // In results.json "a.b" is a member of "a", which would be a number.
      for (const auto& [place, other] : owners)
        if (place.first == metric.scope &&
            (place.second.starts_with(column.name + ".") || column.name.starts_with(place.second + ".")))
          refuse(value + " has one place in results.json with \"" + place.second + "\" of metric " + other);
      if (metric.scope != MetricScope::pair || column.error.empty()) continue;
      const auto [measure, is_first] = measures.insert({column.error, "metric " + metric.name});
      if (!is_first)
        refuse("the error \"" + column.error + "\" needs another name: errors.csv has one of " +
               measure->second);
      else if (column.error.find_first_of(", \"\n\r") != std::string::npos)
        refuse("the error \"" + column.error + "\" needs a name without commas, quotes and blanks");
    }
  }
}

Json json_of(const std::vector<DeclaredMetric>& metrics) {
  Json all = Json::object();
  for (const auto& [name, scope, declaration] : metrics) {
    Json& entry = all[name];
    entry = {{"scope", scope}, {"text", declaration.text}, {"columns", Json::array()}};
    for (const MetricColumn& column : declaration.columns) entry["columns"].push_back(column_json(column));
    for (const MetricColours& c : declaration.colours)
      entry["colours"].push_back(
          {{"field", c.field}, {"other_field", c.other_field}, {"unit", c.unit}, {"label", c.label}});
  }
  return all;
}

std::vector<DeclaredMetric> declared_metrics(const Json& json) {
  std::vector<DeclaredMetric> metrics;
  if (!json.is_object()) return metrics;
  for (const auto& [name, entry] : json.items()) {
    DeclaredMetric metric{name, member_of(entry, "scope").get<MetricScope>(), {}};
    metric.declaration.text = text_member(entry, "text");
    for (const Json& column : member_of(entry, "columns"))
      if (!text_member(column, "name").empty()) metric.declaration.columns.push_back(column_of(column));
    for (const Json& c : member_of(entry, "colours"))
      if (!text_member(c, "field").empty())
        metric.declaration.colours.push_back({text_member(c, "field"), text_member(c, "other_field"),
                                              text_member(c, "unit"), text_member(c, "label")});
    metrics.push_back(std::move(metric));
  }
  return metrics;
}

std::vector<MetricColumn> columns_of(const std::vector<DeclaredMetric>& metrics, MetricScope scope,
                                     Shown least) {
  std::vector<MetricColumn> columns;
  for (const DeclaredMetric& metric : metrics)
    if (metric.scope == scope)
      for (const MetricColumn& column : metric.declaration.columns)
        if (column.shown >= least) add_new(columns, column);
  return columns;
}

void merge(std::vector<DeclaredMetric>& all, const std::vector<DeclaredMetric>& more) {
  for (const DeclaredMetric& metric : more) {
    add_new(all, metric);
    DeclaredMetric& own = *std::ranges::find(all, metric.name, &DeclaredMetric::name);
    for (const MetricColumn& column : metric.declaration.columns) add_new(own.declaration.columns, column);
  }
}

std::vector<ErrorMeasure> error_measures(const std::vector<DeclaredMetric>& metrics) {
  std::vector<ErrorMeasure> measures;
  for (const MetricColumn& column : columns_of(metrics, MetricScope::pair, Shown::stored)) {
    if (column.error.empty()) continue;
    const std::string label = (column.better == Better::higher ? "1 − " : "") + column.label +
                              (column.unit == "1" ? "" : " [" + column.unit + "]");
    add_new(measures, ErrorMeasure{column.error, label, column.error_use, column.name, column.better});
  }
  std::stable_partition(measures.begin(), measures.end(),
                        [](const ErrorMeasure& m) { return m.use == ErrorUse::ranking; });
  measures.push_back({energy_gap, "relative energy gap", ErrorUse::summary, "", Better::lower});
  return measures;
}

}  // namespace drape
