// What metrics declare and give, and results.json, which has it.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/experiment/declared_metrics.h"
#include "core/app/report/run_data.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/interfaces/metric.h"
#include "tests/support/command.h"
#include "tests/support/declared_metrics.h"
#include "tests/support/metric_check.h"
#include "tests/support/refusal.h"
#include "tests/unit/kernel/config_faults.h"

using namespace drape;
using Catch::Contains;
using Catch::EndsWith;

namespace {

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

/// What reading a run says whose results.json and, if it is not empty, errors.csv are these.
std::string said_of_results(const std::string& results, const std::string& errors = "") {
  const Scratch folder;
  folder.write("results.json", results);
  if (!errors.empty()) folder.write("errors.csv", errors);
  const std::string prefix = folder.path.string() + "/", text = refusal_of([&] { read_run(folder.path); });
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

std::string said_of_level(const std::string& level) {
  return said_of_results(R"({"methods": {"pcs": {"levels": [{"level": )" + level + "}]}}}");
}

const std::string again = "; run the experiment again";

/// Declares `tilt` and `spread`, and has this result.
struct GivenMetric : Metric {
  MetricResult result;

  MetricScope scope() const override { return MetricScope::state; }
  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "tilt"}, {.name = "spread"}}};
  }
  MetricResult measure(const MetricInput&) const override { return result; }
};

/// The message with which a result for a level of 9 vertices is refused; empty if it is taken.
std::string refusal_of_result(MetricResult result) {
  const Level level = square(2);
  GivenMetric metric;
  metric.result = std::move(result);
  return refusal_of([&] { metric.evaluate({level, empty_model(), level.rest.vertices}); });
}

}  // namespace

TEST_CASE("what metrics declare goes through results.json unchanged") {
  CHECK(members_of(declared_metrics(json_of(sample_metrics()))) == members_of(sample_metrics()));
}

TEST_CASE("values that have no place of their own in results.json are refused before a run") {
  const auto refused = [](const std::vector<DeclaredMetric>& metrics) {
    ConfigErrors errors;
    check_declarations(metrics, {}, errors);
    CHECK(errors.size() <= 1);
    return texts_of_errors(errors);
  };
  const auto metric = [](const std::string& name, MetricScope scope, const std::vector<std::string>& values) {
    DeclaredMetric declared{name, scope, {}};
    for (const std::string& value : values) declared.declaration.columns.push_back({.name = value});
    return declared;
  };
  const auto error = [](const std::string& name, const std::string& measure) {
    return DeclaredMetric{name, MetricScope::pair, {.columns = {{.name = "of_" + name, .error = measure}}}};
  };
  const auto coloured = [](const std::string& name) {
    return DeclaredMetric{name, MetricScope::pair, {.colours = {{.field = "H"}}}};
  };
  const MetricScope state = MetricScope::state, pair = MetricScope::pair;
  const std::pair<std::vector<DeclaredMetric>, std::string> faults[] = {
      {{metric("a", state, {"energy"})},
       "metric a: the value \"energy\" needs another name: results.json has a key \"energy\" of its own"},
      {{metric("a", state, {"steps.x"})}, "a key \"steps\" of its own"},
      {{metric("a", state, {"contact_stiffness"})}, "a key \"contact_stiffness\" of its own"},
      {{metric("a", pair, {"coarse"})}, "a key \"coarse\" of its own"},
      {{metric("a", state, {"tilt"}), metric("b", state, {"tilt"})},
       "metric b: the value \"tilt\" is declared by metric a too"},
      {{metric("a", state, {"tilt", "tilt"})}, "metric a: the value \"tilt\" is declared twice"},
      {{metric("a", state, {""})}, "metric a: a value needs a name"},
      {{metric("a", state, {"gap"}), metric("b", state, {"gap.mean"})},
       "has one place in results.json with \"gap\" of metric a"},
      {{error("a", "rms"), error("b", "rms")}, "errors.csv has one of metric a"},
      {{error("a", energy_gap)}, "errors.csv has one of the run itself"},
      {{error("a", "a,b")}, "without commas"},
      {{coloured("a"), coloured("b")},
       "metric b: the field \"H\" needs another name: metric a has one of it"}};
  for (const auto& [metrics, fault] : faults) CHECK_THAT(refused(metrics), Contains(fault));
  CHECK(refused({metric("a", state, {"tilt", "coarse"}), metric("b", pair, {"tilt", "energy"})}) == "");
  CHECK(refused({metric("energy", state, {"energy", "energy_parts"})}) == "");
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
  const auto names = [&](Shown shown) {
    std::vector<std::string> all;
    for (const MetricColumn& c : columns_of(metrics, MetricScope::pair, shown)) all.push_back(c.name);
    return joined(all);
  };
  CHECK(names(Shown::tables) ==
        "d_H_fit, d_H_ddg, d_K_fit, d_K_ddg, distance_rms, energy_above_end, silhouette_overlap");
  CHECK(names(Shown::summary) == "d_H_fit");
  const std::string all = names(Shown::stored);
  metrics.push_back({"again", MetricScope::pair, metrics[0].declaration});
  CHECK(names(Shown::stored) == all);

  DeclaredMetric more = metrics[1];
  more.declaration.columns = {{.name = "distance_max", .label = "distance, largest", .unit = "diagonal"}};
  merge(metrics, {more});
  CHECK(metrics[1].declaration.columns.size() == 3);
  CHECK(metrics.size() == 6);
}

TEST_CASE("errors are those that metrics declare, and the energy gap; what ranks comes first") {
  const auto measures = error_measures(sample_metrics());
  std::vector<std::string> names;
  for (const ErrorMeasure& m : measures) names.push_back(m.name);
  CHECK(joined(names) == "rms, d_H_fit, hausdorff, silhouette_mismatch, energy_gap");
  CHECK(measures[0].label == "distance, RMS [diagonal]");
  CHECK(measures[3].label == "1 − silhouette overlap");
  REQUIRE(error_measures({}).size() == 1);
  CHECK(error_measures({})[0].name == "energy_gap");
}

TEST_CASE("a summary has the worst of a method's levels") {
  MethodRecord method;
  const MetricColumn lower{.name = "m"}, higher{.name = "m", .better = Better::higher},
      neither{.name = "m", .better = Better::neither};
  CHECK_FALSE(worst_over_levels(lower, method));
  for (const double value : {2.0, 5.0, 3.0}) method.levels.emplace_back().values["m"] = value;
  CHECK(worst_over_levels(lower, method) == 5);
  CHECK(worst_over_levels(higher, method) == 2);
  CHECK(worst_over_levels(neither, method) == 5);
}

TEST_CASE("results without methods, or that are cut short, are refused") {
  const std::string damaged = "results.json: is damaged", none = ": \"methods\" is not a map" + again;
  CHECK(said_of_results("{") == damaged + " or cut short: it is not a JSON object" + again);
  CHECK(said_of_results("{}") == damaged + none);
  CHECK(said_of_results(R"({"methods": [1]})") == damaged + none);
  CHECK(said_of_results(R"({"methods": {}, "complete": "yes"})") ==
        "results.json: \"complete\" must be true or false, not \"yes\"" + again);
  CHECK(said_of_results(R"({"methods": {}})") == "");
  // Nested a million deep, they end no process.
  CHECK(said_of_level("0, \"snapshots\": " + std::string(1000000, '[') + std::string(1000000, ']')) == "");
}

TEST_CASE("a level that is no whole number is named with its file and its key") {
  const std::string must = " must be a whole number, not ";
  for (const std::string wrong : {"1e+300", "-1", "0.5", "2147483648", "\"finest\""})
    CHECK(said_of_level(wrong) == "results.json: \"level\"" + must + wrong + again);
  for (const std::string right : {"2147483647", "null"}) CHECK(said_of_level(right) == "");
  CHECK(said_of_results(R"({"methods": {"pcs": {"consistency": [{"coarse": 0, "fine": 1e10}]}}})") ==
        "results.json: \"fine\"" + must + "10000000000.0" + again);
}

TEST_CASE("what a file is called that leads out of the run's folder is refused, wherever it is named") {
  const std::string out = "results.json: \"../x.ply\" leads out of the folder" + again, name = "\"../x.ply\"";
  CHECK(said_of_level("0, \"mesh\": " + name) == out);
  CHECK(said_of_level("0, \"mesh\": \"/x.ply\"") ==
        "results.json: \"/x.ply\" leads out of the folder" + again);
  CHECK(said_of_level("0, \"mesh\": \"levels/../x.ply\"") == "");
  CHECK(said_of_results(R"({"methods": {}, "obstacles": [{"mesh": )" + name + "}]}") == out);
  CHECK(said_of_results(R"({"methods": {"pcs": {"consistency": [{"coarse": 0, "fine": 1, "fields": )" + name +
                        "}]}}}") == out);
  const Scratch folder;
  folder.write("results.json",
               R"({"methods": {"pcs": {"levels": [{"snapshots": {"file": )" + name + "}}]}}}");
  const RunData run = read_run(folder.path);
  CHECK_THAT(refusal_of([&] { run.snapshots(run.methods[0].levels[0], 3); }), EndsWith(out));
}

TEST_CASE("a checksum is a whole number of 32 bits") {
  const std::string must = "results.json: \"mesh_checksum\" must be a whole number, not ";
  for (const std::string wrong : {"-1", "0.5", "4294967296", "\"none\""})
    CHECK(said_of_level("0, \"mesh\": \"x.ply\", \"mesh_checksum\": " + wrong) == must + wrong + again);
  CHECK(said_of_level("0, \"mesh\": \"x.ply\", \"mesh_checksum\": 4294967295") == "");
}

TEST_CASE("values within objects have their path as name") {
  const Scratch folder;
  folder.write(
      "results.json",
      R"({"methods": {"pcs": {"levels": [{"height": {"lowest": 0.25, "highest": null, "at 0.5": 3}}]}}})");
  const RunData run = read_run(folder.path);
  const Json& values = run.methods[0].levels[0].values;
  CHECK(number_member(values, "height.lowest") == 0.25);
  CHECK(number_member(values, "height.at 0.5") == 3);
  for (const char* none : {"height.highest", "height", "lowest", "height.lowest.0"})
    CHECK(!number_member(values, none));
}

TEST_CASE("a table of errors that is damaged before its end is refused") {
  CHECK_THAT(said_of_results(R"({"methods": {}})", "method,level,seconds\npcs,0,1\npcs,\npcs,0,1\n"),
             Contains("errors.csv:3: fewer cells than the header has" + again));
  CHECK_THAT(said_of_results(R"({"methods": {}})", "method,level,seconds\npcs,0,1,2\n"),
             Contains("errors.csv:2: more cells than the header has" + again));
  CHECK_THAT(said_of_results(R"({"methods": {}})", "method,level,seconds\n\"pcs,0,1\npcs,0,1\n"),
             Contains("errors.csv:2: a quote (\") has no end"));
}

TEST_CASE("the last line of a killed run's table is left out, within quotes too") {
  for (const std::string line : {"pcs,1", "\"pcs, so"})
    CHECK(said_of_results(R"({"methods": {}})", "method,level,seconds\npcs,0,1\n" + line) == "");
}

TEST_CASE("a metric's values are those that it declares, each in a place of its own") {
  CHECK(refusal_of_result({{{"tilt", 1}, {"spread.a", 2}, {"spread.b", 3}}, {}}).empty());
  CHECK(refusal_of_result({{{"tilted", 1}}, {}}) == "the value \"tilted\" is not among the declared columns");
  CHECK(refusal_of_result({{{"tilt", 1}, {"tilt.b", 2}}, {}}) ==
        "the values \"tilt\" and \"tilt.b\" have one place in results.json");
  CHECK_THAT(refusal_of_result({{{"tilt", 1}, {"tilt", 2}}, {}}), Contains("have one place"));
}

TEST_CASE("a metric's fields have a value for each vertex, and a name that a PLY file can have") {
  const auto refused = [](const std::string& name, Eigen::Index size) {
    return refusal_of_result({{}, {{name, Eigen::VectorXd::Zero(size)}}});
  };
  CHECK(refused("height", 9).empty());
  for (const int size : {0, 3})
    CHECK(refused("height", size) ==
          "the field \"height\" has " + std::to_string(size) + " values, the level 9 vertices");
  for (const char* name : {"", "x", "two words", "two\nlines"})
    CHECK_THAT(refused(name, 9), Contains("needs a name of letters, digits"));
}
