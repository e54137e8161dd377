// What runs with contact write down.

#include "core/app/files/csv.h"
#include "core/kernel/interfaces/level.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/configs/runs.h"

namespace {

const std::string caged = R"({name: caged, cloth: {shape: square, side: 0.4, columns: 9, rows: 9}, levels: 3,
 start: {translate: [-0.2, -0.2, 0.15], perturbation: 1e-3}, check_intersections: every_step,
 energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.06}, gravity],
 contact: {type: ipc, self_contact: false}, friction: 0.1, obstacles: [
   {name: ball, meshed_shape: sphere, radius: 0.1, subdivisions: 2,
    cages: {count: 2, alpha: 0.05, offset: 0.03}}],
 newton: {force_tolerance: 1e-2, step_size: 0.05}, methods: {pcs: {}, cascadic: {}}})";

}  // namespace

TEST_CASE("a run with contact has contacts, gaps and intersections in its results") {
  const Scratch folder(experiment_of_tests("contact"));
  run_into("out", folder,
           "--method all --threads 1 --set check_intersections=every_step --set newton.step_size=0.02 "
           "--set start.translate=[-0.2,-0.2,0.12]");
  const nlohmann::json all = results_in(folder / "out");
  REQUIRE(all["obstacles"].size() == 1);
  CHECK(all["obstacles"][0]["mesh"] == "obstacles/0.ply");
  CHECK(drape::read_mesh(folder / "out/obstacles/0.ply").vertices.rowwise().norm().maxCoeff() ==
        Approx(0.1).epsilon(0.01));
  for (const auto& [name, method] : all["methods"].items()) {
    INFO(name);
    REQUIRE(outcome_of_method(method) == "converged: converged converged");
    for (const nlohmann::json& level : method["levels"]) {
      CHECK(level["intersections"] == 0);
      CHECK(level["smallest_gap"] > 0);
      CHECK(level["smallest_gap"].get<double>() < 1e-3);
      CHECK(level["largest_stretch"].get<double>() < 1.06);
    }
    CHECK((method["levels"][1]["seconds_by_phase"].contains("refinement")) == (name != "newton"));
  }
  int near = 0, far = 0;
  const drape::Csv rows(folder / "out/iterations.csv");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK(rows.text(k, "intersections") == "0");
    const bool any = rows.number(k, "contacts").value() > 0;
    (any ? near : far) += 1;
    CHECK(rows.text(k, "smallest_gap").empty() == !any);
    if (any) CHECK(rows.number(k, "smallest_gap").value() < 1e-3);
  }
  CHECK(near > 10);
  CHECK(far > 0);  // the first steps, in the air
}

TEST_CASE("a state has its contact forces, which carry the weight of a cloth that lies on a floor") {
  const Scratch folder(experiment_of_tests("contact"));
  run_into(
      "out", folder,
      "--method pcs --set 'obstacles=[{name: floor, shape: half_space}]' --set start.translate=[0,0,0.001] "
      "--set start.perturbation=0 --set material.density=1000 --set material.thickness=1e-3 "
      "--set newton.force_tolerance=1e-4");
  for (const std::string level : {"l0", "l1"}) {
    INFO(level);
    const fs::path state = folder / ("out/levels/pcs_" + level + ".ply");
    const drape::VertexFields fields = drape::read_ply_fields(state);
    REQUIRE(fields.size() == 1);
    CHECK(fields[0].name == "contact_pressure");
    const auto rest = drape::Level::of(0, drape::read_mesh(folder / ("out/rest/" + level + ".ply")));
    CHECK(fields[0].values.dot(rest.vertex_area) == Approx(9.81 * 0.4 * 0.4).epsilon(1e-4));
    CHECK_THAT(text_of(fs::path(state).replace_extension(".vtp")), Contains("Name=\"contact_pressure\""));
  }
  // Intersections are counted at the end of each level alone, unless every step is asked for.
  const drape::Csv rows(folder / "out/iterations.csv");
  REQUIRE(rows.size() > 0);
  for (std::size_t k = 0; k < rows.size(); ++k) CHECK(rows.text(k, "intersections") == "");
  CHECK(results_in(folder / "out")["methods"]["pcs"]["levels"][0]["intersections"] == 0);
}

TEST_CASE("obstacle files are found beside the config, through links too; results run again from their own") {
  const Scratch folder;
  for (const char* made : {"project/configs", "project/data", "links/data", "elsewhere"})
    fs::create_directories(folder / made);
  fs::create_directory_symlink("../project/configs", folder / "links/configs");
  drape::TriangleMesh slab = drape::grid({1, 1}, 3, 3, drape::Diagonals::criss_cross);
  slab.vertices.rowwise() -= Eigen::RowVector3d(0.53, 0.52, 0);
  drape::write_mesh(folder / "project/data/slab.obj", slab);
  folder.write("links/data/slab.obj", "not the mesh that ../data means\n");
  folder.write("project/configs/e.yaml",
               replaced(experiment_of_tests("contact"), "obstacles: [",
                        "obstacles: [{name: slab, mesh: ../data/slab.obj, translate: [0, 0, -0.03]}, "));
  const std::string options = " --quiet --no-report --measure --threads 1 --method pcs --out ";
  REQUIRE(drape_with("run ../links/configs/e.yaml" + options + "first", folder / "elsewhere").exit_code == 0);
  const fs::path first = folder / "elsewhere/first", second = folder / "second";
  CHECK_THAT(text_of(first / "config.yaml"),
             Contains(fs::canonical(folder / "project/data/slab.obj").string()));
  drape_ends("run elsewhere/first/config.yaml" + options + "second", folder);
  check_same_files(
      first, second,
      {"config.yaml", "levels/pcs_l0.ply", "levels/pcs_l1.ply", "obstacles/0.ply", "obstacles/1.ply"});
  // It was in the way.
  const double lowest = drape::read_mesh(second / "levels/pcs_l1.ply").vertices.col(2).minCoeff();
  CHECK(lowest > -0.03);
  CHECK(lowest < -0.028);
  fs::remove(folder / "project/data/slab.obj");
  CHECK_THAT(refused_by("check ../links/configs/e.yaml", folder / "elsewhere"),
             Contains("\"slab\"") && Contains("links/configs/../data/slab.obj"));
}

TEST_CASE("a result with intersections is infeasible, and the run did not succeed") {
  const Scratch folder(
      replaced(small_experiment(), "levels: 2",
               "levels: 2\ncontact: {type: blind, height: -0.05}\ncheck_intersections: every_step"));
  const Ended ended =
      drape_with("run e.yaml --out out --method all --set newton.step_size=0.02 -q --no-report --measure",
                 folder.path, "DRAPE_PLUGIN_PATH=" + (folders::test_plugins() / "blind").string());
  CHECK(ended.exit_code == 1);
  for (const char* method : {"pcs", "cascadic", "newton"})
    CHECK_THAT(ended.err, Contains("error: " + std::string(method) +
                                   ": infeasible; level 0 infeasible: the state has intersections"));
  const nlohmann::json all = results_in(folder / "out");
  CHECK(all["complete"] == true);
  REQUIRE(all["methods"].size() == 3);
  for (const auto& [name, method] : all["methods"].items()) {
    INFO(name);
    CHECK(outcome_of_method(method) == "infeasible: infeasible infeasible");
    for (const nlohmann::json& level : method["levels"]) {
      CHECK(level["intersections"] == 1);
      CHECK(level["message"] == "the state has intersections; log.jsonl names them");
      CHECK(level["force_residual"].get<double>() <= 1e-2);  // it converged all the same
    }
  }
  std::string counts;
  const drape::Csv rows(folder / "out/iterations.csv");
  for (std::size_t k = 0; k < rows.size(); ++k) counts += rows.text(k, "intersections");
  CHECK_THAT(counts, StartsWith("0") && Contains("01"));
  CHECK_THAT(text_of(folder / "out/log.jsonl"),
             Contains("\"event\":\"intersection\"") && Contains(" and floor: plane at ("));
}

TEST_CASE("a cloth passes from cage to cage without intersection, and ends on the obstacle itself") {
  const Scratch folder(caged);
  run_into("out", folder, "--method all");
  const auto all = results_in(folder / "out");
  CHECK(drape::read_mesh(folder / "out/obstacles/0.ply").vertices.rows() == 162);  // the ball, no cage
  // The diagonal of the ball's box is 0.35 m: offsets of 10 and, from that, 21 mm, less what triangles of
  // 17 and 35 mm cut off.
  const double nearest[] = {0.126, 0.108, 0.098}, farthest[] = {1, 0.112, 0.1012};
  for (const std::string method : {"pcs", "cascadic"}) {
    INFO(method);
    REQUIRE(outcome_of_method(all["methods"][method]) == "converged: converged converged converged");
    for (int l = 0; l < 3; ++l) {
      const auto& level = all["methods"][method]["levels"][l];
      CHECK(level["intersections"] == 0);
      CHECK(level["smallest_gap"] > 0);
      CHECK(level["smallest_gap"].get<double>() < 1e-3);
      const double distance = drape::read_mesh(folder / ("out/" + level["mesh"].get<std::string>()))
                                  .vertices.rowwise()
                                  .norm()
                                  .minCoeff();
      CHECK(distance > nearest[l]);
      CHECK(distance < farthest[l]);
    }
  }
}
