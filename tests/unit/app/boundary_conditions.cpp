#include "core/app/scene/boundary_conditions.h"

#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/unit/app/scene_refusal.h"

using namespace drape;
using Catch::Contains;

namespace {

/// A sheet of 0.4 m with further keys of the experiment, from line 6 on.
std::string held_sheet(const std::string& keys, const std::string& levels = "2") {
  return "name: held\ncloth: {shape: square, side: 0.4, columns: 5, rows: 5, triangulation: "
         "one_way}\nlevels: " +
         levels + "\nenergies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n" + keys;
}

/// A sheet whose pins (or handles), at lines 8 and 9, hold its left and its lower side, so that both select
/// vertex 0.
std::string two_sides(const std::string& left, const std::string& lower, const std::string& more = "",
                      const std::string& key = "pins") {
  return held_sheet("start: {translate: [0, 0, 0.3]}\n" + key +
                    ":\n  - {region: box, lower: [-1, -1, -1], upper: [0.001, 1, 1]" + left +
                    "}\n  - {region: box, lower: [-1, -1, -1], upper: [1, 0.001, 1]" + lower + "}\n" + more);
}

}  // namespace

TEST_CASE("A vertex that a handle lists twice is pulled once") {
  const auto pulled = [](const std::string& vertices) {
    const Solved s = scene_from(
        held_sheet("handles: [{region: vertices, vertices: " + vertices + ", stiffness: 100}]\n", "1"));
    return s.model().value(Positions(1.1 * s.rest()));
  };
  CHECK(pulled("[24, 7, 24]") == pulled("[7, 24]"));
  CHECK(pulled("[7, 24]") > pulled("[7]"));
}

TEST_CASE("A pin and a handle without a transform hold where the start has them, on every level") {
  const Scratch folder;
  TriangleMesh raised = grid({0.4, 0.4}, 5, 5, Diagonals::one_way);
  raised.vertices.col(2).array() += 0.3;
  write_mesh(folder / "raised.ply", raised);
  for (const std::string& start :
       {std::string("translate: [0, 0, 0.3]"), "file: " + (folder / "raised.ply").string()}) {
    INFO(start);
    const Solved s =
        scene_from(held_sheet("start: {perturbation: 1e-3, " + start +
                              "}\npins: [{region: ball, point: [0, 0, 0], radius: 0.11}]\n"
                              "handles: [{region: ball, point: [0.4, 0.4, 0], radius: 0.11}]\n"));
    for (int l = 0; l < 2; ++l) {
      INFO(l);
      const LevelModel& model = *s.scene->model(l);
      Positions x = model.level().rest.vertices;
      x.col(2).array() += 0.3;
      REQUIRE(model.dirichlet().size() > 2);
      for (const DirichletVertex& d : model.dirichlet()) CHECK(d.target == Eigen::Vector3d(x.row(d.vertex)));
      const auto of_handles = [&](const Positions& at) {
        for (const auto& [name, energy] : model.energy_parts(at))
          if (name == "handles") return energy;
        return -1.0;
      };
      const double far = of_handles(model.level().rest.vertices);
      CHECK(far > 0);
      CHECK(of_handles(x) <= 1e-28 * far);  // the target may be a rounding away from x
    }
  }
}

TEST_CASE(
    "Two pins or handles that want a vertex at different places are refused, with both and the vertex") {
  for (const std::string word : {"pin", "handle"}) {
    const std::string said =
        scene_refusal(two_sides(", translate: [0, 0, 0.3]", ", translate: [0, 0, 0.31]", "", word + "s"));
    CHECK_THAT(said,
               Contains(":9:") && Contains(word + " 1 (box, line 9) and " + word +
                                           " 0 (box, line 8) both select vertex 0 of level 0, at rest at "
                                           "(0, 0, 0), but want it at (0, 0, 0.31) and at (0, 0, 0.3)"));
    CHECK(std::count(said.begin(), said.end(), '\n') == 0);
  }
  // One stays where the start has it, and the other is moved from the rest shape.
  CHECK_THAT(scene_refusal(two_sides("", ", translate: [0, 0, 0]")),
             Contains("(0, 0, 0) and at (0, 0, 0.3)"));
  CHECK_THAT(scene_refusal(two_sides("", ", rotate: [0, 0, 90]")), Contains("both select vertex 0"));
  // They may meet on a finer level alone.
  CHECK_THAT(scene_refusal(held_sheet(
                 "refiner: midpoint\npins:\n  - {region: box, lower: [0, 0, 0], upper: [0.06, 1, 1]}\n"
                 "  - {region: box, lower: [0.04, 0, 0], upper: [0.1, 1, 1], translate: [0, 0, 0.1]}\n")),
             Contains("of level 1, at rest at (0.05, "));
}

TEST_CASE("Pins and handles may share vertices that they want at the same place") {
  const std::string up = ", translate: [0, 0, 0.3]", centre = "centre: [0.1, 0.2, 0.3]";
  CHECK(scene_refusal(two_sides("", "")) == "");
  CHECK(scene_refusal(two_sides("", up)) == "");
  // The rotation is about the corner that they share.
  CHECK(scene_refusal(two_sides(", rotate: [0, 30, 0]" + up, up)) == "");
  CHECK(scene_refusal(two_sides(", rotate: [10, 20, 30], " + centre, ", rotate: [370, 20, 30], " + centre)) ==
        "");
  // A pin counts more than a handle, which may pull anywhere.
  CHECK(scene_refusal(two_sides("", "", "handles: [{region: border, translate: [0, 0, 1]}]\n")) == "");
}

TEST_CASE("A schedule that moves one of two pins away from the other is refused, at its values") {
  const auto keys = [](const std::string& list) { return "schedule: {steps: 4, keys: [" + list + "]}\n"; };
  const std::string up = ".translate, times: [0, 1], values: [[0, 0, 0.3], [0, 0, 0.5]]}",
                    left = "{parameter: pins.0" + up, lower = "{parameter: pins.1" + up;
  CHECK_THAT(scene_refusal(two_sides("", "", keys(left))),
             Contains("key \"pins.0.translate\" at pseudo-time 0.382: pin 0 (box) and pin 1 (box) both "
                      "select vertex 0") &&
                 Contains(":10:"));
  // Together they move as one.
  CHECK(scene_refusal(two_sides("", "", keys(left + ", " + lower))) == "");
  // Away and back, to where the other pin is at the key's times.
  const std::string logarithmic =
      "{parameter: pins.1.translate.2, times: [0, 1], values: [0.3, 0.5], interpolation: log}";
  CHECK_THAT(scene_refusal(two_sides("", ", translate: [0, 0, 0.3]", keys(left + ", " + logarithmic))),
             Contains("both select vertex 0"));
  // A region that grows into another one's.
  const std::string apart = held_sheet(
      "pins:\n  - {region: ball, point: [0, 0, 0], radius: 0.01}\n"
      "  - {region: nearest, point: [0, 0, 0], translate: [0, 0, 0]}\n"
      "  - {region: nearest, point: [0.1, 0, 0], translate: [0, 0, 0.2]}\n",
      "1");
  CHECK(scene_refusal(apart) == "");
  CHECK_THAT(
      scene_refusal(apart +
                    keys("{parameter: pins.2.point, times: [0, 2], values: [[0.1, 0, 0], [0, 0, 0]]}")),
      Contains(
          "key \"pins.2.point\" at pseudo-time 2: pin 2 (nearest) and pin 0 (ball) both select vertex 0") &&
          Contains("pin 2 (nearest) and pin 1 (nearest)"));
}
