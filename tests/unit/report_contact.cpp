// What a report says of contact: verdict, troubles, consistency, the Newton steps of the coarsest level.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/report/chart_data.h"
#include "core/app/report/tables.h"
#include "tests/support/declared_metrics.h"

using namespace drape;
using Json = nlohmann::ordered_json;

namespace {

LevelRecord level_of(int index, OptionalNumber intersections, OptionalNumber gap) {
  LevelRecord level;
  level.level = index;
  level.status = "converged";
  level.intersections = intersections;
  level.smallest_gap = gap;
  return level;
}

MethodRecord method_of(const std::string& name, double d_H_fit) {
  MethodRecord method;
  method.name = name;
  method.status = "converged";
  method.levels = {level_of(0, 0, 2e-4), level_of(1, 0, 3e-4)};
  ConsistencyRecord pair;
  pair.coarse = 0;
  pair.fine = 1;
  pair.metrics.set("d_H_fit", d_H_fit);
  method.consistency = {pair};
  return method;
}

RunData contact_run() {
  RunData run;
  run.experiment = "sample";
  run.metrics = sample_metrics();
  run.methods = {method_of("pcs", 12), method_of("a<b", 345)};
  RecordedIteration row;
  row.smallest_gap = 1.5e-5;
  run.iterations = {{"pcs", 0, {row, row}}};
  return run;
}

std::string verdict_of(const RunData& run, bool intersection_free) {
  const auto verdict = intersection_verdict(run);
  REQUIRE(verdict);
  CHECK(verdict->intersection_free == intersection_free);
  return verdict->text;
}

}  // namespace

TEST_CASE("a run's verdict on intersections counts the checked states") {
  RunData run = contact_run();
  CHECK(verdict_of(run, true) ==
        "No intersection at any recorded state (4 levels checked, smallest gap on the way 1.50e-5 m).");
  run.iterations[0].rows[1].intersections = 0;
  CHECK(verdict_of(run, true) ==
        "No intersection at any recorded state (4 levels and 1 iteration checked, smallest gap on the way "
        "1.50e-5 m).");
}

TEST_CASE("one intersection anywhere is in the verdict") {
  RunData run = contact_run();
  SECTION("in a level's state") {
    run.methods[1].levels[1].intersections = 3;
    CHECK(verdict_of(run, false) ==
          "Intersections: a<b, level 1: 3 intersecting pairs. log.jsonl names the first ones.");
  }
  SECTION("on the way") {
    run.iterations[0].rows[0].intersections = 2;
    CHECK(verdict_of(run, false) ==
          "Intersections: pcs, level 0: intersections in 1 iteration. log.jsonl names the first ones.");
  }
}

TEST_CASE("a run without contact has no verdict and no columns for it") {
  RunData run = contact_run();
  CHECK(summary_table(run).find("intersections") != std::string::npos);
  CHECK(level_table(run).find("smallest gap") != std::string::npos);
  for (MethodRecord& method : run.methods)
    for (LevelRecord& level : method.levels) level.intersections = level.smallest_gap = OptionalNumber();
  CHECK_FALSE(intersection_verdict(run));
  CHECK(summary_table(run).find("intersections") == std::string::npos);
  CHECK(level_table(run).find("smallest gap") == std::string::npos);
}

TEST_CASE("levels that did not converge are listed with their messages") {
  RunData run = contact_run();
  CHECK(troubles(run).empty());
  LevelRecord& level = run.methods[1].levels[0];
  level.status = "stalled";
  level.message = "held by cloth triangle 3 & ball";
  level.iterations = 1;
  level.force_residual = 1.01;
  const std::string text = troubles(run);
  CHECK(text.find("<b>a&lt;b</b>, level 0: stalled after 1 iterations at force residual 1.01: held by cloth "
                  "triangle 3 &amp; ball") != std::string::npos);

  level.status = "converged_to_rounding";
  CHECK(troubles(run) ==
        "<p>Remarks on what converged:</p>\n<ul>\n<li><b>a&lt;b</b>, level 0: held by cloth triangle 3 "
        "&amp; "
        "ball</li>\n</ul>\n");
}

TEST_CASE("The table of consistency has a column for every method, and the flat start's") {
  RunData run = contact_run();
  const auto has = [&](const std::string& cells) {
    return consistency_table(run).find(cells) != std::string::npos;
  };
  CHECK(has("<th>pcs</th><th>a&lt;b</th><th>flat start</th>"));
  CHECK(has("<td><strong>12.0</strong></td><td>345</td><td>–</td>"));
  run.methods[0].consistency[0].metrics.set("silhouette_overlap", 0.98);
  run.methods[1].consistency[0].of_start.set("d_H_fit", 34);
  CHECK(has("<td><strong>12.0</strong></td><td>345</td><td>34.0</td>"));
  CHECK(has("<td>0.980</td><td>–</td><td>–</td>"));
  run.methods[0].consistency[0].of_start.set("d_H_fit", 33);
  CHECK(has("<td>345</td><td>33.0 … 34.0</td>"));
  for (MethodRecord& method : run.methods) method.consistency.clear();
  CHECK(has("No pair of levels has been compared in this run."));
}

TEST_CASE("No method is the best on a measure that the flat start would win") {
  RunData run = contact_run();
  const auto pair = [&](int m) -> ConsistencyRecord& { return run.methods[m].consistency[0]; };
  const auto is_best = [&](const std::string& figure) {
    return consistency_table(run).find("<td><strong>" + figure + "</strong></td>") != std::string::npos;
  };
  CHECK(is_best("12.0"));  // nothing is known of the start, as in runs of earlier versions
  CHECK(outcome_sentence(run).find("changes its mean curvature least") != std::string::npos);
  pair(0).of_start.set("d_H_fit", 12.5);
  CHECK(is_best("12.0"));
  for (const double start : {12.0, 11.0}) {
    pair(0).of_start.set("d_H_fit", start);
    CHECK_FALSE(is_best("12.0"));
    CHECK_FALSE(is_best("345"));
    CHECK(outcome_sentence(run).find("changes its mean curvature least") == std::string::npos);
  }

  // Of silhouettes the higher is the better; against the flat start too.
  pair(0).metrics.set("silhouette_overlap", 0.91), pair(1).metrics.set("silhouette_overlap", 0.93);
  CHECK(is_best("0.930"));
  CHECK_FALSE(is_best("0.910"));
  pair(1).of_start.set("silhouette_overlap", 0.9);
  CHECK(is_best("0.930"));
  pair(1).of_start.set("silhouette_overlap", 0.93);
  CHECK_FALSE(is_best("0.930"));

  // An energy below the end's is no better than one as far above it.
  pair(0).metrics.set("energy_above_end", -0.02), pair(1).metrics.set("energy_above_end", 0.01);
  CHECK(is_best("0.0100"));
  CHECK_FALSE(is_best("-0.0200"));
}

TEST_CASE("Newton steps are the decrement times h, which a static method has from its settings") {
  RunData run = contact_run();
  run.methods[1].step_size = 0.5;
  RecordedIteration row;
  row.decrement = 4;
  row.step_size = std::numeric_limits<double>::infinity();  // of a static step
  run.iterations = {{"pcs", 0, {row}}, {"a<b", 0, {row}}};
  run.iterations[0].rows[0].step_size = 0.25;
  Json data = Json::parse(chart_data(run));
  CHECK(data["coarsest"] == 0);
  CHECK(data["series"][0]["step"] == Json::array({1}));
  CHECK(data["series"][1]["step"] == Json::array({2}));
  run.methods[1].step_size.reset();
  CHECK(Json::parse(chart_data(run))["series"][1]["step"] == Json::array({nullptr}));
}
