// Runs of a cloth that is the finest level of its hierarchy.

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/configs/resuming.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"
#include "tests/support/tube_dress.h"

using namespace drape;

namespace {

/// A panel of 400 vertices that falls over a ball, with one coarser level.
void write_panel(const Scratch& folder) {
  write_mesh(folder / "panel.obj", random_triangulation({0.4, 0.4}, 400, 1));
  folder.write("e.yaml", R"(
name: panel
cloth: {shape: file, file: panel.obj}
hierarchy: {coarsen: 1}
material: {membrane_modulus: 8e4, bending_modulus: 8e4}
start: {translate: [-0.2, -0.2, 0.105], perturbation: 1e-3, perturbation_wavelength: 0.1}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{shape: sphere, radius: 0.1}]
friction: 0.3
newton: {force_tolerance: 1e-2}
methods: {pcs: {}}
)");
}

const std::string run_panel = "run e.yaml --quiet --no-report --measure --threads 1 --checkpoint 0 --out ";

}  // namespace

TEST_CASE(
    "A run on coarsened levels has the file's mesh as its finest level, and resumes from its own copy") {
  const Scratch folder;
  write_panel(folder);
  drape_ends(run_panel + "whole", folder);
  const TriangleMesh panel = read_mesh(folder / "panel.obj"),
                     finest = read_mesh(folder / "whole/rest/l1.ply");
  CHECK((finest.vertices == panel.vertices));
  CHECK((finest.triangles == panel.triangles));
  CHECK(read_mesh(folder / "whole/rest/l0.ply").vertices.rows() < 150);
  CHECK_FALSE(fs::exists(folder / "whole/rest/l2.ply"));

  DrapeAtWork command(run_panel + "out", folder);
  wait_for_steps(command, folder / "out", 8);
  REQUIRE(command.ended_by(SIGINT).exit_code == 130);
  fs::remove(folder / "panel.obj");
  drape_ends(go_on, folder);
  check_equal(folder / "out", folder / "whole");
}

TEST_CASE("check prints the levels under the cloth's mesh") {
  const Scratch folder;
  write_panel(folder);
  CHECK_THAT(drape_ends("check e.yaml", folder).out,
             Catch::Contains(", 400\n") && Catch::Contains("level 0 under the cloth's mesh: ") &&
                 Catch::Contains(" edges, smallest angle "));
}

TEST_CASE("The number of coarser levels follows from the vertices that the coarsest one should have") {
  const Scratch folder;
  write_panel(folder);
  const auto levels = [&](const std::string& hierarchy) {
    const Experiment e = experiment_in(folder / "e.yaml", {{"hierarchy", hierarchy}});
    return std::pair(e.parameters.hierarchy.coarsen, e.parameters.levels);
  };
  CHECK(levels("{coarsest: 100}") == std::pair(1, 1));
  CHECK(levels("{coarsest: 25}") == std::pair(2, 1));
  CHECK(levels("{coarsest: 390}") == std::pair(0, 1));
  CHECK(levels("{coarsest: 100, coarsen: 1}") == std::pair(1, 1));
  CHECK_THROWS_WITH(levels("{coarsest: 100, coarsen: 2}"),
                    Catch::Contains("asks for 2 coarser levels by \"coarsen\", and for 1 by \"coarsest\""));
}

TEST_CASE("A refined cushion has levels below it, although few vertices make its panels touch") {
  const Scratch folder;
  const fs::path config = folders::source() / "configs/cushion.yaml";
  write_mesh(folder / "cushion.obj", scene_of(experiment_in(config))->hierarchy.levels[2].rest);
  const Solved s = solved(experiment_in(config, {{"cloth.file", (folder / "cushion.obj").string()},
                                                 {"levels", "1"},
                                                 {"hierarchy", "{coarsen: 2}"}}),
                          "pcs");
  REQUIRE(s.levels.size() == 3);
  for (const LevelResult& level : s.levels) {
    INFO(level.message);
    CHECK(level.message.empty());
    CHECK(level.outcome == Outcome::converged);
    for (const auto& contact : s.scene->models[level.level]->contacts())
      CHECK(contact->intersections(level.x).empty());
  }
}

TEST_CASE("A finer level begins beside a sharp rim over which the coarse cloth is folded") {
  const Solved s =
      solved(experiment_in(folders::source() / "configs/tablecloth.yaml", {{"cloth.vertices", "1600"},
                                                                           {"levels", "1"},
                                                                           {"refiner", "coarsen"},
                                                                           {"hierarchy", "{coarsen: 1}"}}),
             "pcs");
  REQUIRE(s.levels.size() == 2);
  CHECK(s.levels[1].message.empty());  // else it starts from the scene's start
  CHECK(s.levels[1].outcome == Outcome::converged);
  for (const auto& contact : s.scene->models[1]->contacts())
    CHECK(contact->intersections(s.levels[1].x).empty());
}

TEST_CASE(
    "A moulded cap has levels below it, and each finer one starts with the curvature that it rests with") {
  const Scratch folder;
  write_mesh(folder / "cap.obj", hemisphere(1200));
  folder.write("e.yaml", R"(
name: cap
cloth: {shape: file, file: cap.obj}
hierarchy: {coarsen: 2}
material: {membrane_modulus: 1e6, bending_modulus: 8e7}
start: {translate: [0, 0, 0.005], perturbation: 1e-4}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{shape: sphere, radius: 0.08}]
friction: 0.3
newton: {force_tolerance: 1e-2}
methods: {pcs: {}}
)");
  const Solved s = solved(experiment_in(folder / "e.yaml"));
  REQUIRE(s.levels.size() == 3);
  const Hierarchy& hierarchy = s.scene->hierarchy;
  for (const LevelResult& level : s.levels) {
    INFO(level.message);
    CHECK(level.message.empty());
    CHECK(level.outcome == Outcome::converged);
    CHECK(level.from_initial_state == (level.level == 0));
    for (const auto& contact : s.scene->models[level.level]->contacts())
      CHECK(contact->intersections(level.x).empty());
  }
  for (const int l : {0, 1}) {
    const auto above_end = [&](const Positions& x) {
      return s.scene->models[l + 1]->energy_without_contact(x) -
             s.scene->models[l + 1]->energy_without_contact(s.levels[l + 1].x);
    };
    const double with = above_end(hierarchy.prolong(s.levels[l].x, l, l + 1, hierarchy.linear)),
                 without = above_end(hierarchy.linear[l] * s.levels[l].x);
    INFO(with << " J above the end of level " << l + 1 << ", " << without << " J without offsets");
    CHECK(with < 0.5 * without);
  }
}

TEST_CASE("A garment with levels below it is dressed on the coarsest, and each finer one starts from it") {
  const Scratch folder;
  TubeDress tube;
  tube.write(folder,
             "hierarchy: {coarsen: 1}\n"
             "pins: [{region: box, lower: [-1, -1, 0.099], upper: [1, -0.01, 1]}]\n"
             "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
             "energies: [neo_hookean, hinge, gravity]\n");
  const Solved s = solved(experiment_in(folder / "e.yaml", {{"methods", "{pcs: {}}"}}));
  REQUIRE(s.levels.size() == 2);
  for (const LevelResult& level : s.levels) {
    INFO(level.message);
    CHECK(level.message.empty());
    CHECK(level.outcome == Outcome::converged);
    CHECK(level.from_initial_state == (level.level == 0));
  }
}
