// Runs of a cloth that is the finest level of its hierarchy.

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/configs/resuming.h"

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
