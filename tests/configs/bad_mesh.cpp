// What the command says to a cloth from a bad mesh file: the file, and the line or the element.

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/command.h"

namespace {

/// A square of 3 × 3 vertices, 0 to 8 by rows, in 8 triangles; vertices are lines 1 to 9, faces 10 to 17.
const std::string sheet =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n"
    "f 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\nf 4 5 8\nf 4 8 7\nf 5 6 9\nf 5 9 8\n";

std::string experiment_with(const std::string& mesh_name) {
  return replaced(small_experiment(), "{shape: square, side: 1, columns: 6, rows: 6}",
                  "{shape: file, file: " + mesh_name + "}");
}

/// Standard error of a run, and of a check, of the experiment in a subfolder with this mesh beside it.
std::string said_of_mesh(const std::string& mesh, const std::string& mesh_name = "cloth.obj",
                         const std::string& arguments = "") {
  const Scratch folder;
  std::filesystem::create_directory(folder / "in");
  folder.write("in/e.yaml", experiment_with(mesh_name));
  folder.write("in/" + mesh_name, mesh);
  const std::string said = refused_by("run in/e.yaml --out out " + arguments, folder.path);
  CHECK(!std::filesystem::exists(folder / "out"));
  CHECK(refused_by("check in/e.yaml " + arguments, folder.path) == said);
  return said;
}

}  // namespace

TEST_CASE("a valid mesh file runs, and its results can be run again from their own config") {
  // Coordinates are converted once, though both results folders name a file.
  for (const std::string coordinates : {"", ", unit: inch, up: y, scale: 20, rotate: [0, 0, 90]"}) {
    const Scratch folder;
    folder.write("cloth.obj", sheet);
    folder.write("e.yaml",
                 replaced(replaced(experiment_with("cloth.obj"), "cloth.obj", "cloth.obj" + coordinates),
                          "start: {scale: [0.9, 0.9, 1]",
                          coordinates.empty() ? "start: {scale: [0.9, 0.9, 1]"
                                              : "start: {file: cloth.obj, scale: [19, 20, 19]"));
    const std::string options = " --quiet --no-report --threads 1 --method pcs --out ";
    drape_ends("run e.yaml" + options + "first", folder);
    std::filesystem::remove(folder / "cloth.obj");
    drape_ends("run first/config.yaml" + options + "second", folder);
    for (const std::string file : {"config.yaml", "rest/l0.ply", "levels/pcs_l0.ply", "levels/pcs_l1.ply"})
      CHECK((text_of(folder / ("first/" + file)) == text_of(folder / ("second/" + file))));
  }
}

TEST_CASE("a malformed mesh file is named with its line, a shape without what it needs with its key") {
  CHECK(said_of_mesh(replaced(sheet, "v 1 1 0\n", "v 1 one 0\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj:5: 'one' is not a number\n");
  CHECK(said_of_mesh(sheet, "cloth.obj", "--set 'cloth={shape: file}'") ==
        "error: --set cloth: \"shape: file\" needs \"file\", the mesh to read\n");
  CHECK(said_of_mesh(sheet, "cloth.obj", "--set 'cloth={shape: polygon}'") ==
        "error: --set cloth: \"shape: polygon\" needs \"loops\", its outline and holes\n");
}

TEST_CASE("a mesh file without a mesh is refused") {
  const std::string file = "error: in/e.yaml:2:8: in/cloth.obj: ";
  CHECK(said_of_mesh("") == file + "is empty\n");
  CHECK(said_of_mesh("v 0 0 0\n") ==
        file + "the mesh has no triangles\n" + file +
            "the mesh is 0 m across; at least 1e-09 m can be computed with\n" + file +
            "1 vertex belongs to no triangle: 0 (counted from 0); remove them\n");
}

TEST_CASE("all faults of a mesh are listed at once") {
  const std::string said =
      said_of_mesh(sheet + "v 5 5 5\nf 1 2 5\nf 1 1 2\nv 0 0 1\nf 1 11 5\nv 0 0 2\nv 1 0 2\nf 9 12 13\n");
  for (const std::string fault :
       {"1 vertex belongs to no triangle: 9", "1 triangle repeats a vertex: 9",
        "1 triangle has the same vertices as another: 8 ", "1 edge has more than two triangles: (0, 4)",
        "1 vertex joins separate fans of triangles: 8 of 2 fans"})
    CHECK_THAT(said, Catch::Contains(fault));
  CHECK(std::count(said.begin(), said.end(), '\n') == 5);
}

TEST_CASE("bending for flat rest shapes names where a mesh file is curved") {
  const std::string bent = replaced(sheet, "v 1 1 0\n", "v 1 1 0.5\n");
  CHECK(said_of_mesh(bent, "cloth.obj", "--set 'energies=[neo_hookean, quadratic_bending, gravity]'") ==
        "error: --set energies: quadratic_bending: the rest shape of level 0 is not flat (angle 0.420534 at "
        "the edge of vertices 1 and 4); use hinge\n");
}
