// Runs whose coarse levels meet cages around an obstacle.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/numerics/mesh_files/io.h"
#include "tests/support/command.h"

namespace {

const std::string caged = R"(name: caged
cloth: {shape: square, side: 0.4, columns: 9, rows: 9}
levels: 3
start: {translate: [-0.2, -0.2, 0.15], perturbation: 1e-3}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.06}, gravity]
contact: {type: ipc, self_contact: false}
obstacles:
  - {name: ball, meshed_shape: sphere, radius: 0.1, subdivisions: 2, cages: {count: 2, alpha: 0.05, offset: 0.03}}
friction: 0.1
newton: {force_tolerance: 1e-2, step_size: 0.05}
check_intersections: every_step
methods: {pcs: {}, cascadic: {}}
)";

double nearest_to_centre(const std::filesystem::path& ply) {
  return drape::read_mesh(ply).vertices.rowwise().norm().minCoeff();
}

}  // namespace

TEST_CASE("a cloth passes from cage to cage without intersection, and ends on the obstacle itself") {
  const Scratch folder(caged);
  drape_ends("run e.yaml --out out --method all --quiet --no-report", folder);
  const auto all = json_in(folder / "out/results.json");
  CHECK(drape::read_mesh(folder / "out/obstacles/0.ply").vertices.rows() == 162);  // the ball, no cage
  for (const std::string method : {"pcs", "cascadic"}) {
    INFO(method);
    CHECK(all["methods"][method]["status"] == "converged");
    REQUIRE(all["methods"][method]["levels"].size() == 3);
    for (const auto& level : all["methods"][method]["levels"]) {
      CHECK(level["intersections"] == 0);
      CHECK(level["smallest_gap"].get<double>() > 0);
      CHECK(level["smallest_gap"].get<double>() < 1e-3);
    }
    // The diagonal of the ball's box is 0.35 m: offsets of 10 and, from that, 21 mm, less what triangles of
    // 17 and 35 mm cut off.
    const auto at = [&](const std::string& level) {
      return nearest_to_centre(folder / ("out/levels/" + method + "_l" + level + ".ply"));
    };
    CHECK(at("0") > 0.126);
    CHECK(at("1") > 0.108);
    CHECK(at("1") < 0.112);
    CHECK(at("2") < 0.1012);
    CHECK(at("2") > 0.098);
  }
}

TEST_CASE("a start within a cage is refused, which is named") {
  const Scratch folder(replaced(caged, "0.15], perturbation", "0.11], perturbation"));
  CHECK_THAT(refused_by("check e.yaml", folder.path),
             Catch::Contains("the start of level 0 touches: cloth triangle ") &&
                 Catch::Contains(" and ball (cage 0) triangle "));
}
