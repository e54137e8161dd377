#include <catch2/catch.hpp>

#include "tests/support/command.h"
#include "tests/support/metric_check.h"
#include "tests/support/solve.h"

TEST_CASE("cloth at rest on a plate has neither forces nor a decrement") {
  const Scratch folder(R"(name: resting
cloth: {shape: square, side: 0.2, columns: 4, rows: 4}
levels: 1
start: {translate: [-0.1, -0.1, 0.0009]}
energies: [neo_hookean, hinge, gravity]
contact: {type: shapes, dhat: 1e-3}
obstacles: [{shape: half_space}]
newton: {force_tolerance: 1e-6}
methods: {newton: {}}
)");
  drape_ends("run e.yaml --measure --out out --quiet --no-report", folder);
  const auto level = json_in(folder / "out/results.json")["methods"]["newton"]["levels"][0];
  CHECK(level["force_residual_plain"].get<double>() < 1e-5);  // null is below any number
  CHECK(level["decrement_plain"].get<double>() < 1e-4);
  const Solved falling = scene_from(replaced(text_of(folder / "e.yaml"), "0.0009", "1"));
  const auto in_air = make_plugin_from<drape::Metric>("residuals")
                          ->evaluate({falling.level(), falling.model(), falling.scene->starts.back()});
  CHECK(value(in_air, "force_residual_plain") == Approx(1));
  CHECK(value(in_air, "decrement_plain") == Approx(9.81 * 0.1));  // g h
}
