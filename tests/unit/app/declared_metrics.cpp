#include "core/app/experiment/declared_metrics.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/report/run_data.h"
#include "core/app/report/run_table.h"
#include "tests/support/command.h"
#include "tests/support/declared_metrics.h"

using namespace drape;
using Catch::Contains;

namespace {

std::vector<std::string> names_of(const std::vector<MetricColumn>& columns) {
  std::vector<std::string> names;
  for (const MetricColumn& c : columns) names.push_back(c.name);
  return names;
}

/// Every member of every declaration.
std::vector<std::string> members_of(const std::vector<DeclaredMetric>& metrics) {
  std::vector<std::string> all;
  const auto number = [](auto value) { return std::to_string(static_cast<int>(value)); };
  for (const DeclaredMetric& m : metrics) {
    all.insert(all.end(), {m.name, number(m.scope), m.declaration.text});
    for (const MetricColumn& c : m.declaration.columns)
      all.insert(all.end(),
                 {c.name, c.label, c.unit, number(c.better), number(c.shown), c.error, number(c.error_use)});
    for (const MetricColours& c : m.declaration.colours)
      all.insert(all.end(), {c.field, c.other_field, c.unit, c.label});
  }
  return all;
}

/// Reads a run with these results, and this errors.csv if it is not empty.
RunData run_of(const Json& results, const std::string& errors = "") {
  const Scratch folder;
  folder.write("results.json", results.dump());
  if (!errors.empty()) folder.write("errors.csv", errors);
  return read_run(folder.path);
}

}  // namespace

TEST_CASE("what metrics declare goes through results.json unchanged") {
  CHECK(members_of(declared_metrics(json_of(sample_metrics()))) == members_of(sample_metrics()));
}

TEST_CASE("values that have no place of their own in results.json are refused before a run") {
  const auto refused = [](const std::vector<DeclaredMetric>& metrics) {
    ConfigErrors errors;
    check_declarations(metrics, {}, errors);
    std::string text;
    for (const ConfigError& error : errors) text += error.message + "\n";
    return text;
  };
  const auto metric = [](const std::string& name, MetricScope scope, const std::vector<std::string>& values) {
    DeclaredMetric declared{name, scope, {}};
    for (const std::string& value : values) declared.declaration.columns.push_back({.name = value});
    return declared;
  };
  const MetricScope state = MetricScope::state, pair = MetricScope::pair;
  CHECK(refused({metric("a", state, {"tilt", "coarse"}), metric("b", pair, {"tilt", "energy"})}).empty());
  CHECK(refused({metric("energy", state, {"energy", "energy_parts"})}).empty());
  CHECK(refused({metric("a", state, {"energy"})}) ==
        "metric a: the value \"energy\" needs another name: results.json has a key \"energy\" of its own\n");
  CHECK_THAT(refused({metric("a", state, {"steps.x"})}), Contains("a key \"steps\" of its own"));
  CHECK_THAT(refused({metric("a", pair, {"coarse"})}), Contains("a key \"coarse\" of its own"));
  CHECK(refused({metric("a", state, {"tilt"}), metric("b", state, {"tilt"})}) ==
        "metric b: the value \"tilt\" is declared by metric a too\n");
  CHECK(refused({metric("a", state, {"tilt", "tilt"})}) ==
        "metric a: the value \"tilt\" is declared twice\n");
  CHECK(refused({metric("a", state, {""})}) == "metric a: a value needs a name\n");
  CHECK_THAT(refused({metric("a", state, {"contact_stiffness"})}),
             Contains("a key \"contact_stiffness\" of its own"));
  CHECK_THAT(refused({metric("a", state, {"gap"}), metric("b", state, {"gap.mean"})}),
             Contains("has one place in results.json with \"gap\" of metric a"));
  const auto error = [](const std::string& name, const std::string& value, const std::string& measure) {
    return DeclaredMetric{name, MetricScope::pair, {.columns = {{.name = value, .error = measure}}}};
  };
  CHECK_THAT(refused({error("a", "x", "rms"), error("b", "y", "rms")}),
             Contains("errors.csv has one of metric a"));
  CHECK_THAT(refused({error("a", "x", energy_gap)}), Contains("errors.csv has one of the run itself"));
  CHECK_THAT(refused({error("a", "x", "a,b")}), Contains("without commas"));
  DeclaredMetric first{"a", pair, {}}, second{"b", pair, {}};
  first.declaration.colours = second.declaration.colours = {{.field = "H"}};
  CHECK(refused({first, second}) == "metric b: the field \"H\" needs another name: metric a has one of it\n");
}

TEST_CASE("declarations that someone edited are read as far as they can be") {
  for (const char* text :
       {"null", "3", "[]", R"({"a": 1})", R"({"a": {"columns": 1, "colours": [1, {"field": 2}]}})",
        R"({"a": {"columns": [1, {}, {"name": 2}]}})"}) {
    INFO(text);
    for (const DeclaredMetric& metric : declared_metrics(Json::parse(text))) {
      CHECK(metric.declaration.columns.empty());
      CHECK(metric.declaration.colours.empty());
    }
  }
  const auto odd = declared_metrics(Json::parse(R"({"a": {"columns": [{"name": "b", "better": "x"}]}})"));
  REQUIRE(odd.at(0).declaration.columns.size() == 1);
  CHECK(odd[0].declaration.columns[0].better == Better::neither);
}

TEST_CASE("columns come in the order of declaration, each name once, as widely shown as asked for") {
  std::vector<DeclaredMetric> metrics = sample_metrics();
  CHECK((names_of(columns_of(metrics, MetricScope::pair, Shown::tables)) ==
         std::vector<std::string>{"d_H_fit", "d_H_ddg", "d_K_fit", "d_K_ddg", "distance_rms",
                                  "energy_above_end", "silhouette_overlap"}));
  CHECK((names_of(columns_of(metrics, MetricScope::pair, Shown::summary)) ==
         std::vector<std::string>{"d_H_fit"}));
  const std::size_t all = columns_of(metrics, MetricScope::pair, Shown::stored).size();
  metrics.push_back({"again", MetricScope::pair, metrics[0].declaration});
  CHECK(columns_of(metrics, MetricScope::pair, Shown::stored).size() == all);

  DeclaredMetric more = metrics[1];
  more.declaration.columns = {{.name = "distance_max", .label = "distance, largest", .unit = "diagonal"}};
  merge(metrics, {more});
  CHECK(metrics[1].declaration.columns.size() == 3);
  CHECK(metrics.size() == 6);
}

TEST_CASE("errors are those that metrics declare, and the energy gap; what ranks comes first") {
  std::vector<std::string> names;
  for (const ErrorMeasure& m : error_measures(sample_metrics())) names.push_back(m.name);
  CHECK((names ==
         std::vector<std::string>{"rms", "d_H_fit", "hausdorff", "silhouette_mismatch", "energy_gap"}));
  CHECK(error_measures(sample_metrics())[0].label == "distance, RMS [diagonal]");
  CHECK(error_measures(sample_metrics())[3].label == "1 − silhouette overlap");
  REQUIRE(error_measures({}).size() == 1);
  CHECK(error_measures({})[0].name == "energy_gap");
}

TEST_CASE("a summary has the worst of a method's levels") {
  MethodRecord method;
  const MetricColumn lower{.name = "m"}, higher{.name = "m", .better = Better::higher},
      neither{.name = "m", .better = Better::neither};
  CHECK_FALSE(worst_over_levels(lower, method));
  for (const double value : {2.0, 5.0, 3.0}) method.levels.emplace_back().values.json["m"] = value;
  CHECK(worst_over_levels(lower, method) == 5);
  CHECK(worst_over_levels(higher, method) == 2);
  CHECK(worst_over_levels(neither, method) == 5);
}

TEST_CASE(
    "a table of errors that is cut short at its end is read as far as it goes, one damaged before is "
    "refused") {
  const std::string header = "method,level,seconds\n", row = "pcs,0,1\n";
  CHECK(run_of({{"methods", Json::object()}}, header + row + row + "pcs,").errors.size() == 2);
  CHECK_THROWS_WITH(run_of({{"methods", Json::object()}}, header + row + "pcs,\n" + row),
                    Contains("errors.csv:3: fewer cells than the header has; run the experiment again"));
}
