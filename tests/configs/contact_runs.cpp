// What runs with contact refuse, and what they write down.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/files/csv.h"
#include "core/kernel/interfaces/level.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"

namespace fs = std::filesystem;
using Catch::Contains;

namespace {

std::string contact_experiment() { return experiment_of_tests("contact"); }

/// Standard error of a run that is refused, as a check is.
std::string said_of_contact(const std::string& experiment, const std::string& arguments = "") {
  const Scratch folder(experiment);
  const std::string said = refused_by("run e.yaml --out out " + arguments, folder.path);
  CHECK(!fs::exists(folder / "out"));
  CHECK(refused_by("check e.yaml " + arguments, folder.path) == said);
  return said;
}

const std::string quiet = " --quiet --no-report --threads 1 ";

}  // namespace

TEST_CASE("a start that touches an obstacle is refused, with the pairs and the location") {
  const std::string text = contact_experiment(), place = "error: e.yaml:4:8: the start of level 0 touches: ";
  CHECK(said_of_contact(text, "--set start.translate=[-0.2,-0.2,0.099] --set start.perturbation=0") ==
        place + "cloth triangle 54 and ball: sphere at (-0.01667, -0.03333, 0.099)\n" + place +
            "cloth triangle 55 and ball: sphere at (-0.03333, -0.01667, 0.099)\n" + place +
            "cloth triangle 57 and ball: sphere at (0.01667, -0.01667, 0.099)\n"
            "error: e.yaml:4:8: … and 3 more pairs; move the start and the obstacle apart, or let "
            "--allow-start-repair do it\n");
  const std::string table =
      "[{name: table, meshed_shape: box, size: [0.01, 0.01, 0.2], translate: [0.135, 0.12, 0.02]}]";
  CHECK_THAT(said_of_contact(text, "--set start.perturbation=0 --set 'obstacles=" + table + "'"),
             Catch::StartsWith(place + "cloth triangle 108 and table triangle 4 at (0.135, 0.115, 0.11)\n"));
  CHECK_THAT(
      said_of_contact(text, "--set 'pins=[{point: [0.2, 0.2, 0], translate: [-0.2, -0.2, 0]}]'"),
      Catch::StartsWith("error: e.yaml:4:8: the start of level 0 touches (pinned vertices begin at their "
                        "targets): cloth triangle "));
}

TEST_CASE("a start is checked on every level") {
  // Noise whose valleys only the finer level is fine enough for.
  const std::string said = said_of_contact(
      replaced(contact_experiment(), "{type: strain_limit, limit: 1.06}, ", ""),
      "--set contact=shapes --set 'obstacles=[{name: floor, shape: half_space}]' --set "
      "start.perturbation=5e-3 --set start.perturbation_wavelength=0.06 --set start.translate=[0,0,0.0075]");
  CHECK_THAT(said, Catch::StartsWith("error: e.yaml:4:8: the start of level 1 touches: cloth triangle ") &&
                       Contains(" and floor: half_space at ("));
}

TEST_CASE("a cloth that crosses itself is refused") {
  const Scratch folder;
  folder.write("cloth.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -0.5\nv 0.3 0.2 -0.5\nv 0.25 0.25 0.5\n"
               "f 1 2 3\nf 4 5 6\n");
  folder.write("e.yaml",
               "name: crossed\ncloth: {shape: file, file: cloth.obj}\nlevels: 1\n"
               "energies: [neo_hookean, gravity]\ncontact: ipc\nmethods: {newton: {}}\n");
  CHECK_THAT(refused_by("check e.yaml", folder.path),
             Catch::StartsWith("error: e.yaml:1:1: the start of level 0 touches: cloth triangle 0 and cloth "
                               "triangle 1 at (0.2"));
  CHECK_THAT(refused_by("check e.yaml --allow-start-repair", folder.path),
             Catch::StartsWith("error: e.yaml:1:1: moving the start by up to ") &&
                 Contains(" does not part cloth triangle 0 and cloth triangle 1 at (0.2") &&
                 Catch::EndsWith(" on level 0; change the start's shape or the obstacle\n"));
}

TEST_CASE("a run with contact has contacts, gaps and intersections in its results") {
  const Scratch folder(contact_experiment());
  drape_ends(
      "run e.yaml --out out --method all --set check_intersections=every_step --set "
      "start.translate=[-0.2,-0.2,0.12] "
      "--set newton.step_size=0.02" +
          quiet,
      folder);
  const nlohmann::json all = json_in(folder / "out/results.json");
  REQUIRE(all["obstacles"].size() == 1);
  CHECK(all["obstacles"][0]["mesh"] == "obstacles/0.ply");
  CHECK(drape::read_mesh(folder / "out/obstacles/0.ply").vertices.rowwise().norm().maxCoeff() ==
        Approx(0.1).epsilon(0.01));
  for (const auto& [name, method] : all["methods"].items()) {
    INFO(name);
    CHECK(method["status"] == "converged");
    REQUIRE(method["levels"].size() == 2);
    for (const nlohmann::json& level : method["levels"]) {
      CHECK(level["intersections"] == 0);
      CHECK(level["smallest_gap"].get<double>() > 0);
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
  const Scratch folder(contact_experiment());
  drape_ends(
      "run e.yaml --out out --method pcs --set 'obstacles=[{name: floor, shape: half_space}]' --set "
      "start.translate=[0,0,0.001] --set start.perturbation=0 --set material.density=1000 --set "
      "material.thickness=1e-3 --set newton.force_tolerance=1e-4" +
          quiet,
      folder);
  for (const char* level : {"l0", "l1"}) {
    INFO(level);
    const fs::path state = folder / ("out/levels/pcs_" + std::string(level) + ".ply");
    const drape::VertexFields fields = drape::read_ply_fields(state);
    REQUIRE(fields.size() == 1);
    CHECK(fields[0].name == "contact_pressure");
    const auto rest =
        drape::Level::of(0, drape::read_mesh(folder / ("out/rest/" + std::string(level) + ".ply")));
    CHECK(fields[0].values.dot(rest.vertex_area) == Approx(9.81 * 0.4 * 0.4).epsilon(1e-4));
    CHECK_THAT(text_of(fs::path(state).replace_extension(".vtp")), Contains("Name=\"contact_pressure\""));
  }
}

TEST_CASE("intersections are counted at the end of each level alone, unless every step is asked for") {
  const Scratch folder(contact_experiment());
  drape_ends("run e.yaml --out out --method newton --levels 1" + quiet, folder);
  const drape::Csv rows(folder / "out/iterations.csv");
  REQUIRE(rows.size() > 0);
  for (std::size_t k = 0; k < rows.size(); ++k) CHECK(rows.text(k, "intersections") == "");
  CHECK(json_in(folder / "out/results.json")["methods"]["newton"]["levels"][0]["intersections"] == 0);
}

TEST_CASE("obstacle files are found beside the config, and results run again from their own config") {
  const Scratch folder;
  fs::create_directories(folder / "in/meshes");
  fs::create_directory(folder / "elsewhere");
  drape::TriangleMesh slab = drape::grid({1, 1}, 3, 3, drape::Diagonals::criss_cross);
  slab.vertices.rowwise() -= Eigen::RowVector3d(0.53, 0.52, 0);
  drape::write_mesh(folder / "in/meshes/slab.obj", slab);
  folder.write("in/e.yaml", replaced(contact_experiment(), "obstacles: [",
                                     "obstacles: [{name: slab, mesh: meshes/slab.obj, "
                                     "translate: [0, 0, -0.03]}, "));
  const std::string options = quiet + "--method pcs --out ";
  const Ended first = drape_with("run ../in/e.yaml" + options + "first", folder / "elsewhere");
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  drape_ends("run elsewhere/first/config.yaml" + options + "second", folder);
  for (const std::string file :
       {"config.yaml", "levels/pcs_l0.ply", "levels/pcs_l1.ply", "obstacles/0.ply", "obstacles/1.ply"}) {
    INFO(file);
    CHECK((text_of(folder / ("elsewhere/first/" + file)) == text_of(folder / ("second/" + file))));
  }
  // It was in the way.
  const double lowest = drape::read_mesh(folder / "second/levels/pcs_l1.ply").vertices.col(2).minCoeff();
  CHECK(lowest > -0.03);
  CHECK(lowest < -0.028);
  fs::remove(folder / "in/meshes/slab.obj");
  CHECK_THAT(refused_by("check ../in/e.yaml", folder / "elsewhere"),
             Contains("\"slab\"") && Contains("meshes/slab.obj"));
}

TEST_CASE("an obstacle's path may lead up from a folder that is reached by a link") {
  const Scratch folder;
  for (const char* made : {"project/configs", "project/data", "links/data"})
    fs::create_directories(folder / made);
  fs::create_directory_symlink("../project/configs", folder / "links/configs");
  drape::write_mesh(folder / "project/data/slab.obj",
                    drape::grid({1, 1}, 3, 3, drape::Diagonals::criss_cross));
  folder.write("links/data/slab.obj", "not the mesh that ../data means\n");
  folder.write("project/configs/e.yaml", replaced(contact_experiment(), "obstacles: [",
                                                  "obstacles: [{name: slab, mesh: ../data/slab.obj, "
                                                  "translate: [0, 0, -0.5]}, "));
  drape_ends("run links/configs/e.yaml --levels 1 --out out" + quiet, folder);
  const std::string saved = text_of(folder / "out/config.yaml");
  CHECK_THAT(saved, Contains(fs::canonical(folder / "project/data/slab.obj").string()));
  shown_by("check out/config.yaml", folder.path);
  fs::remove(folder / "project/data/slab.obj");
  CHECK_THAT(refused_by("check links/configs/e.yaml", folder.path),
             Contains("links/configs/../data/slab.obj"));
}

TEST_CASE("a result with intersections is infeasible, and the run did not succeed") {
  const Scratch folder(
      replaced(small_experiment(), "levels: 2",
               "levels: 2\ncontact: {type: blind, height: -0.05}\ncheck_intersections: every_step"));
  const Ended ended =
      drape_with("run e.yaml --out out --method all --set newton.step_size=0.02" + quiet, folder.path,
                 "DRAPE_PLUGIN_PATH=" + (folders::test_plugins() / "blind").string());
  CHECK(ended.exit_code == 1);
  CHECK(ended.err == "");
  const nlohmann::json all = json_in(folder / "out/results.json");
  CHECK(all["complete"] == true);
  REQUIRE(all["methods"].size() == 3);
  for (const auto& [name, method] : all["methods"].items()) {
    INFO(name);
    CHECK(method["status"] == "infeasible");
    for (const nlohmann::json& level : method["levels"]) {
      CHECK(level["intersections"] == 1);
      CHECK(level["status"] == "infeasible");
      CHECK(level["message"] == "the state has intersections; log.jsonl names them");
      CHECK(level["force_residual"].get<double>() <= 1e-2);  // it converged all the same
    }
  }
  std::string counts;
  const drape::Csv rows(folder / "out/iterations.csv");
  for (std::size_t k = 0; k < rows.size(); ++k) counts += rows.text(k, "intersections");
  CHECK_THAT(counts, Catch::StartsWith("0") && Contains("01"));
  CHECK_THAT(text_of(folder / "out/log.jsonl"),
             Contains("\"event\":\"intersection\"") && Contains(" and floor: plane at ("));
}
