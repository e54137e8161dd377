#include "core/kernel/interfaces/metric.h"

#include <catch2/catch.hpp>

#include "core/numerics/model/level_model.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/refusal.h"

using namespace drape;
using Catch::Contains;

namespace {

/// Declares `tilt` and `spread`, and has this result.
struct Given : Metric {
  MetricResult result;

  MetricScope scope() const override { return MetricScope::state; }
  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "tilt"}, {.name = "spread"}}};
  }

 private:
  MetricResult measure(const MetricInput&) const override { return result; }
};

/// The message with which a result is refused; empty if it is taken.
std::string refusal(MetricResult result) {
  const Level level = Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way));
  const LevelModel model(level, Material(), {}, {});
  Given metric;
  metric.result = std::move(result);
  return refusal_of([&] { metric.evaluate({level, model, level.rest.vertices}); });
}

const Eigen::VectorXd of_level = Eigen::VectorXd::Zero(9);

}  // namespace

TEST_CASE("a metric's values are those that it declares, each in a place of its own") {
  CHECK(refusal({{{"tilt", 1}, {"spread.a", 2}, {"spread.b", 3}}, {}}).empty());
  CHECK(refusal({{{"tilted", 1}}, {}}) == "the value \"tilted\" is not among the declared columns");
  CHECK(refusal({{{"tilt", 1}, {"tilt", 2}}, {}}) ==
        "the values \"tilt\" and \"tilt\" have one place in results.json");
  CHECK_THAT(refusal({{{"tilt", 1}, {"tilt.b", 2}}, {}}), Contains("have one place"));
}

TEST_CASE("a metric's fields have a value for each vertex, and a name that a PLY file can have") {
  CHECK(refusal({{}, {{"height", of_level}}}).empty());
  CHECK(refusal({{}, {{"height", Eigen::VectorXd::Zero(3)}}}) ==
        "the field \"height\" has 3 values, the level 9 vertices");
  CHECK_THAT(refusal({{}, {{"height", Eigen::VectorXd()}}}), Contains("has 0 values"));
  for (const char* name : {"", "x", "two words", "two\nlines"})
    CHECK_THAT(refusal({{}, {{name, of_level}}}), Contains("needs a name of letters, digits"));
}
