// Medians over starts, and which of them are bold.

#include <catch2/catch.hpp>
#include <cmath>

#include "core/app/report/run_table.h"

using namespace drape;

namespace {

/// A row of a start of a method, with these times; NaN stands for none.
Json row(const char* method, int seed, double seconds, double error, bool reference = false) {
  const auto json = [](double value) { return std::isnan(value) ? Json() : Json(value); };
  return {{"variation", "a"},
          {"run", "a"},
          {"seed", seed},
          {"method", method},
          {"status", "converged"},
          {"physics", 0},
          {"machine", ""},
          {"reference", reference},
          {"seconds", json(seconds)},
          {"energy_gap", json(error)}};
}

std::vector<TableRow> summary(std::vector<TableRow> rows) {
  RunTable table;
  table.columns = {"run", "seed", "method", "status", "seconds", "energy_gap"};
  table.rows = std::move(rows);
  return summary_of(table, {});
}

const double none = std::nan("");

}  // namespace

TEST_CASE("a value is bold where its range over starts is apart from every other, and nowhere else") {
  // The median is lower, the ranges overlap: times of a preview that were once shown as a winner's.
  const auto overlapping =
      summary({row("pcs", 1, 0.143, none), row("pcs", 2, 0.177, none), row("pcs", 3, 0.373, none),
               row("newton", 1, 0.0494, none), row("newton", 2, 0.194, none), row("newton", 3, 0.243, none)});
  REQUIRE(overlapping.size() == 2);
  CHECK(overlapping[0]["seconds"] ==
        Json({{"median", 0.177}, {"low", 0.143}, {"high", 0.373}, {"count", 3}}));
  for (const Json& each : overlapping) CHECK(each["best"].empty());
  const auto apart = summary({row("pcs", 1, 1, none), row("pcs", 2, 2, none), row("newton", 1, 2.5, none),
                              row("newton", 2, 3, none)});
  CHECK(apart[0]["best"] == Json::array({"seconds"}));
  CHECK(apart[1]["best"].empty());
  // Apart, but 0.206 (0.205–0.206) beside 0.205 (0.205–0.205) is all that a reader sees.
  for (const Json& each : summary({row("pcs", 1, 0.2046, none), row("pcs", 2, 0.2048, none),
                                   row("newton", 1, 0.2049, none), row("newton", 2, 0.206, none)}))
    CHECK(each["best"].empty());
}

TEST_CASE("iterations of methods are not compared") {
  RunTable table;
  table.columns = {"method", "seed", "iterations"};
  for (const int seed : {1, 2})
    for (const char* method : {"pcs", "newton"}) {
      table.rows.push_back(row(method, seed, 1, none));
      table.rows.back()["iterations"] = method == std::string("pcs") ? 240 : 110;
    }
  for (const Json& each : summary_of(table, {})) CHECK(each["best"].empty());
}

TEST_CASE("one start has no range, and where one has none, none is bold") {
  for (const auto& rows : {summary({row("pcs", 1, 1, none), row("newton", 1, 2, none)}),
                           summary({row("pcs", 1, 1, none), row("pcs", 2, 1, none), row("newton", 1, 2, none),
                                    row("newton", 2, none, none)})})
    for (const Json& each : rows) CHECK(each["best"].empty());
}

TEST_CASE("a method that is the reference has no rival in the distance from it") {
  const auto two = summary({row("pcs", 1, 1, none, true), row("pcs", 2, 1, none, true),
                            row("newton", 1, 1, 0.1), row("newton", 2, 1, 0.2)});
  CHECK(two[0]["reference"] == 2);
  CHECK(two[0]["energy_gap"].is_null());
  CHECK(two[1]["best"].empty());  // the only other one is not the best
  const auto three =
      summary({row("pcs", 1, 1, none, true), row("pcs", 2, 1, 0.01), row("newton", 1, 1, 0.1),
               row("newton", 2, 1, 0.2), row("cascadic", 1, 1, -0.02), row("cascadic", 2, 1, 0.03)});
  CHECK(three[2]["best"] == Json::array({"energy_gap"}));
  CHECK(three[0]["best"].empty());
}

TEST_CASE("a method has converged if all its levels have, and only such starts count") {
  std::vector<TableRow> rows;
  for (const char* status : {"converged", "converged, max_steps_reached", "converged_to_rounding, converged",
                             "converged, failed"}) {
    rows.push_back(row("pcs", static_cast<int>(rows.size()), 1, none));
    rows.back()["status"] = status;
  }
  const auto of_four = summary(rows);
  REQUIRE(of_four.size() == 1);
  CHECK(of_four[0]["converged"] == "2 of 4");
  CHECK(of_four[0]["starts"] == 4);
  CHECK(of_four[0]["seconds"]["count"] == 2);
}
