#include "core/app/scene/boundary_conditions.h"

#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// A sheet of 0.4 m with further keys of the experiment, from line 6 on.
std::string held_sheet(const std::string& keys, const std::string& levels = "2") {
  return "name: held\ncloth: {shape: square, side: 0.4, columns: 5, rows: 5, triangulation: "
         "one_way}\nlevels: " +
         levels + "\nenergies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n" + keys;
}

/// A sheet whose pins hold its left and its lower side, so that both select vertex 0.
std::string two_sides(const std::string& left, const std::string& lower, const std::string& more = "") {
  return held_sheet(
      "start: {translate: [0, 0, 0.3]}\npins:\n  - {region: box, lower: [-1, -1, -1], upper: [0.001, 1, 1]" +
      left + "}\n  - {region: box, lower: [-1, -1, -1], upper: [1, 0.001, 1]" + lower + "}\n" + more);
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

TEST_CASE("Pins and handles may share vertices that they want at the same place") {
  const std::string up = ", translate: [0, 0, 0.3]", centre = "centre: [0.1, 0.2, 0.3]";
  CHECK_NOTHROW(scene_from(two_sides("", "")));
  CHECK_NOTHROW(scene_from(two_sides("", up)));
  // The rotation is about the corner that they share.
  CHECK_NOTHROW(scene_from(two_sides(", rotate: [0, 30, 0]" + up, up)));
  CHECK_NOTHROW(
      scene_from(two_sides(", rotate: [10, 20, 30], " + centre, ", rotate: [370, 20, 30], " + centre)));
  // A pin counts more than a handle, which may pull anywhere.
  CHECK_NOTHROW(scene_from(two_sides("", "", "handles: [{region: border, translate: [0, 0, 1]}]\n")));
}

TEST_CASE("A schedule may move pins together, and one that another does not meet") {
  const auto keys = [](const std::string& list) { return "schedule: {steps: 4, keys: [" + list + "]}\n"; };
  const std::string up = ".translate, times: [0, 1], values: [[0, 0, 0.3], [0, 0, 0.5]]}";
  CHECK_NOTHROW(scene_from(two_sides("", "", keys("{parameter: pins.0" + up + ", {parameter: pins.1" + up))));
  CHECK_NOTHROW(
      scene_from(held_sheet("pins:\n  - {region: ball, point: [0, 0, 0], radius: 0.01}\n"
                            "  - {region: nearest, point: [0, 0, 0], translate: [0, 0, 0]}\n"
                            "  - {region: nearest, point: [0.1, 0, 0], translate: [0, 0, 0.2]}\n",
                            "1")));
}
