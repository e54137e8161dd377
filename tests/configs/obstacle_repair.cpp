// A cloth drapes over obstacles of every kind of fault.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace {

/// A pyramid of 20 cm without its base; vertices 1 to 4 are its corners, 5 its tip.
const std::string pyramid =
    "v -0.1 -0.1 0\nv 0.1 -0.1 0\nv 0.1 0.1 0\nv -0.1 0.1 0\nv 0 0 0.1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

const std::string wild = R"(name: wild
cloth: {shape: square, side: 0.3, columns: 9, rows: 9}
levels: 1
start: {translate: [-0.15, -0.15, 0.115], perturbation: 1e-3}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{name: scan, mesh: scan.obj}, {name: floor, shape: half_space, translate: [0, 0, -0.05]}]
friction: 0.3
newton: {force_tolerance: 1e-2}
check_intersections: every_step
methods: {newton: {}}
)";

}  // namespace

TEST_CASE("a cloth drapes over obstacles that are no surface with one side up") {
  const auto [more, said] = GENERATE(table<std::string, std::string>({
      {"", ""},
      {"v 9 9 9\nv 8 8 8\n", "dropped 2 loose vertices"},
      {"f 1 5 2\nf 2 3 5\n", "dropped 2 doubled triangles"},
      {"f 1 2 2\nv 0 -0.1 0\nf 1 6 2\n", "dropped 2 triangles without area"},
      {"v 0.02 0 0.1\nv 0 0.02 0.1\nv 0 0 0.06\nf 1 5 3\n",
       "dropped 3 loose vertices; kept 2 edges with more than two triangles"},
      {"v 0.02 0 0.14\nv -0.02 0.02 0.14\nv -0.02 -0.02 0.14\nf 5 6 7\nf 5 7 8\nf 5 8 6\n",
       "kept 1 vertex with separate fans of triangles"},
      {"v 0 -0.2 0.05\nf 1 2 6\n", "kept 1 edge between triangles that face opposite ways"},
      {"v 0.02 0 0.05\nf 5 1 6\nf 5 1 4\nv 7 7 7\nf 3 3 2\nf 1 5 3\nv 0.1 0.1 0.05\nv 0.12 0.1 0.05\nf 3 8 "
       "9\n",
       "dropped "},
      {"v -0.3 0 0\nv -0.2 0 0\nv -0.2 0.1 0.02\nf 6 7 8\n", ""},
  }));
  CAPTURE(more);
  const Scratch folder;
  folder.write("scan.obj", pyramid + more);
  const std::string start =
      said.starts_with("kept 1 vertex") ? " --set start.translate=[-0.15,-0.15,0.155]" : "";
  folder.write("e.yaml", wild);
  const std::string checked = drape_ends("check e.yaml" + start, folder).out;
  const std::string line = "obstacle scan: " + said;
  CHECK(said.empty() == (checked.find("obstacle scan") == std::string::npos));
  if (!said.empty()) CHECK_THAT(checked, Catch::Contains(line));
  const Ended ended = drape_ends("run e.yaml --out out --no-report --threads 1" + start, folder);
  if (!said.empty()) CHECK_THAT(ended.err, Catch::Contains("remark: " + line));
  const auto results = json_in(folder / "out/results.json");
  CHECK(results.contains("remarks") == !said.empty());
  const auto& level = results["methods"]["newton"]["levels"][0];
  CHECK(level["status"] == "converged");
  CHECK(level["intersections"] == 0);
  CHECK(level["smallest_gap"].get<double>() > 0);
}

TEST_CASE("cages enclose a repaired obstacle, and its animation moves") {
  const std::string faults = "v 9 9 9\nv 0 -0.2 0.05\nf 1 2 5\nf 1 2 7\nf 2 2 3\n";
  const Scratch folder;
  folder.write("scan.obj", pyramid + faults);
  folder.write("higher.obj", replaced(pyramid, "v 0 0 0.1\n", "v 0 0 0.13\n") + faults);
  folder.write("caged.yaml",
               replaced(replaced(wild, "mesh: scan.obj", "mesh: scan.obj, cages: {count: 1, offset: 0.02}"),
                        "0.115]", "0.15]"));
  const std::string moving = replaced(wild, "mesh: scan.obj", "animation: [scan.obj, higher.obj]");
  folder.write(
      "moving.yaml",
      moving +
          "schedule: {steps: 3, keys: [{parameter: obstacles.scan.frame, times: [0, 1], values: [0, 1]}]}\n");
  for (const std::string name : {"caged", "moving"}) {
    CHECK_THAT(drape_ends("run " + name + ".yaml --out " + name + " --no-report --threads 1", folder).err,
               Catch::Contains("remark: obstacle scan: dropped 1 loose vertex, 1 doubled triangle and 1 "
                               "triangle without area; kept 1 edge between"));
    const auto level = json_in(folder / (name + "/results.json"))["methods"]["newton"]["levels"][0];
    CHECK(level["status"] == "converged");
    CHECK(level["intersections"] == 0);
  }
}
