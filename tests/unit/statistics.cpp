#include "core/app/report/statistics.h"

#include <catch2/catch.hpp>

using namespace drape;

TEST_CASE("a spread is the median and the extremes") {
  CHECK(!spread_of({}));
  const Spread one = *spread_of({3});
  CHECK((one.median == 3 && one.low == 3 && one.high == 3 && one.count == 1));
  const Spread odd = *spread_of({9, 1, 4});
  CHECK((odd.median == 4 && odd.low == 1 && odd.high == 9 && odd.count == 3));
  CHECK(spread_of({4, 1, 9, 5})->median == 4.5);
}

TEST_CASE("the Pareto front of a known set") {
  //                                 0       1       2       3       4       5       6
  const std::vector<CostPoint> points = {{1, 9}, {2, 9}, {3, 4}, {2, 5}, {5, 4}, {6, 1}, {6, 2}};
  CHECK(pareto_front(points) == std::vector<std::size_t>{0, 3, 2, 5});
  CHECK(pareto_front({{1, 1}, {1, 1}}) == std::vector<std::size_t>{0});
  CHECK(pareto_front({}).empty());
}

TEST_CASE("a median curve is of the state that each repeat has at a cost") {
  const std::vector<std::vector<CostPoint>> repeats = {
      {{1, 8}, {10, 4}, {100, 2}}, {{1, 6}, {10, 3}, {100, 1}}, {{1, 7}, {20, 5}, {50, 0.5}}};
  const std::vector<CurvePoint> curve = median_curve(repeats, 3);  // at 1, 10 and 100
  REQUIRE(curve.size() == 3);
  CHECK(curve[0].cost == 1);
  CHECK(curve[0].error.median == 7);
  CHECK(curve[1].cost == Approx(10));
  CHECK(curve[1].error.high == 7);  // of the third, whose next state comes at 20
  CHECK(curve[2].cost == 100);
  CHECK(curve[2].error.median == 1);
  CHECK(curve[2].error.low == 0.5);  // which stays what it was at 50
  CHECK(curve[2].error.count == 3);
}

TEST_CASE("a median curve begins where every repeat has a state and leaves out what has no logarithm") {
  const std::vector<CurvePoint> curve = median_curve({{{0, 9}, {2, 4}, {8, 0}}, {{4, 3}, {16, 2}}, {}}, 2);
  REQUIRE(curve.size() == 2);
  CHECK(curve.front().cost == 4);
  CHECK(curve.front().error.high == 4);
  CHECK(curve.back().cost == 16);
  CHECK(median_curve({{{3, 1}}}, 5).size() == 1);
  CHECK(median_curve({}, 5).empty());
}
