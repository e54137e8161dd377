// What the command says to a cloth from a bad mesh file: the file, and the line or the element.

#include <sys/stat.h>

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
  const Scratch folder;
  folder.write("cloth.obj", sheet);
  folder.write("e.yaml", experiment_with("cloth.obj"));
  const std::string options = " --quiet --no-report --threads 1 --method pcs --out ";
  REQUIRE(drape_with("run e.yaml" + options + "first", folder.path).exit_code == 0);
  std::filesystem::remove(folder / "cloth.obj");
  REQUIRE(drape_with("run first/config.yaml" + options + "second", folder.path).exit_code == 0);
  for (const std::string file : {"config.yaml", "rest/l0.ply", "levels/pcs_l0.ply", "levels/pcs_l1.ply"})
    CHECK((text_of(folder / ("first/" + file)) == text_of(folder / ("second/" + file))));
}

TEST_CASE("a missing or unreadable mesh file") {
  const Scratch folder;
  folder.write("e.yaml", experiment_with("cloth.obj"));
  const Ended ended = drape_with("run e.yaml --out out", folder.path);
  CHECK(ended.exit_code == 2);
  CHECK(ended.err == "error: e.yaml:2:8: cannot read cloth.obj: No such file or directory\n");
  CHECK(!std::filesystem::exists(folder / "out"));
  CHECK(said_of_mesh("solid", "cloth.stl") ==
        "error: in/e.yaml:2:8: in/cloth.stl: unknown mesh format '.stl'; known are .obj, .off, .ply\n");
  CHECK(said_of_mesh(sheet, "cloth.obj", "--set 'cloth={shape: file}'") ==
        "error: --set cloth: \"shape: file\" needs \"file\", the mesh to read\n");
  CHECK(said_of_mesh(sheet, "cloth.obj", "--set 'cloth={shape: polygon}'") ==
        "error: --set cloth: \"shape: polygon\" needs \"loops\", its outline and holes\n");
}

TEST_CASE("a malformed mesh file is named with its line") {
  CHECK(said_of_mesh(replaced(sheet, "v 1 1 0\n", "v 1 one 0\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj:5: 'one' is not a number\n");
  CHECK(said_of_mesh(replaced(sheet, "v 1 1 0\n", "v 1 nan 0\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj:5: 'nan' is not a finite coordinate\n");
  CHECK(said_of_mesh(replaced(sheet, "v 1 1 0\n", "v 1 1\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj:5: a vertex needs three coordinates\n");
  CHECK(said_of_mesh(replaced(sheet, "f 5 9 8\n", "f 5 9 10\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj:17: face names vertex 10, but 9 vertices precede it\n");
  CHECK(said_of_mesh(replaced(sheet, "f 5 9 8\n", "f 5 9\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj:17: a face needs at least three vertices\n");
  CHECK(
      said_of_mesh("OFF\n3 1 0\n0 0 0\n1 0 0\n", "cloth.off") ==
      "error: in/e.yaml:2:8: in/cloth.off:4: the file ends before vertex 2 (the header declares 3 vertices, "
      "1 faces)\n");
  CHECK(said_of_mesh("ply\nformat ascii 1.0\nelement vertex 3\n", "cloth.ply") ==
        "error: in/e.yaml:2:8: in/cloth.ply:3: the header has no end_header\n");
}

TEST_CASE("a mesh that is no surface with one side up is named with the element") {
  CHECK(said_of_mesh(replaced(sheet, "f 5 9 8\n", "f 5 8 9\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj: edge (4, 7) runs in the same direction in triangles 4 and 7 "
        "(counted from 0): "
        "one of them is inverted\n"
        "error: in/e.yaml:2:8: in/cloth.obj: edge (4, 8) runs in the same direction in triangles 6 and 7 "
        "(counted from 0): "
        "one of them is inverted\n"
        "error: in/e.yaml:2:8: in/cloth.obj: triangle 7 (4, 7, 8) faces the other way than most of this flat "
        "mesh (counted from 0)\n");
  CHECK(said_of_mesh("") == "error: in/e.yaml:2:8: in/cloth.obj: is empty\n");
  CHECK(said_of_mesh("v 0 0 0\n") ==
        "error: in/e.yaml:2:8: in/cloth.obj: the mesh has no triangles\n"
        "error: in/e.yaml:2:8: in/cloth.obj: vertex 0 belongs to no triangle (counted from 0)\n");
  CHECK(said_of_mesh(sheet + "v 0 0 1\nf 1 10 5\n") ==
        "error: in/e.yaml:2:8: in/cloth.obj: edge (0, 4) has 3 triangles: 0, 1, 8 (counted from 0)\n");
  CHECK(said_of_mesh(replaced(sheet, "f 5 9 8\n", "f 5 9 9\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj: triangle 7 (4, 8, 8) repeats a vertex (counted from 0)\n");
  CHECK(said_of_mesh(replaced(sheet, "v 2 2 0\n", "v 1 1 0\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj: triangle 6 (4, 5, 8) has no area (counted from 0)\n"
        "error: in/e.yaml:2:8: in/cloth.obj: triangle 7 (4, 8, 7) has no area (counted from 0)\n");
  CHECK(said_of_mesh(sheet + "f 1 2 5\n") ==
        "error: in/e.yaml:2:8: in/cloth.obj: triangle 8 (0, 1, 4) has the same vertices as triangle 0 "
        "(counted from 0)\n"
        "error: in/e.yaml:2:8: in/cloth.obj: edge (0, 1) runs in the same direction in triangles 0 and 8 "
        "(counted from 0): "
        "one of them is inverted\n"
        "error: in/e.yaml:2:8: in/cloth.obj: edge (0, 4) has 3 triangles: 0, 1, 8 (counted from 0)\n"
        "error: in/e.yaml:2:8: in/cloth.obj: edge (1, 4) has 3 triangles: 0, 3, 8 (counted from 0)\n");
  CHECK(said_of_mesh(sheet + "v 5 5 5\n") ==
        "error: in/e.yaml:2:8: in/cloth.obj: vertex 9 belongs to no triangle (counted from 0)\n");
}

TEST_CASE("bending for flat rest shapes names where a mesh file is curved") {
  const std::string bent = replaced(sheet, "v 1 1 0\n", "v 1 1 0.5\n");
  CHECK(said_of_mesh(bent, "cloth.obj", "--set 'energies=[neo_hookean, quadratic_bending, gravity]'") ==
        "error: --set energies: quadratic_bending: the rest shape of level 0 is not flat (angle 0.420534 at "
        "the edge of vertices 1 and 4); use hinge\n");
}

TEST_CASE("few faults are listed for any number in a mesh") {
  std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int k = 0; k < 200000; ++k) mesh += " 1 2 3";
  const std::string said = said_of_mesh(mesh + "\n");
  CHECK(said.size() < 10000);
  CHECK_THAT(said, Catch::Matchers::Contains("in/cloth.obj: and ") &&
                       Catch::Matchers::EndsWith("more faults like these\n"));

  mesh = "v 0 0 0\nv 1 0 0\n";
  for (int k = 0; k < 1000; ++k)
    mesh += "v " + std::to_string(k) + " 1 " + std::to_string(k) + "\nf 1 2 -1\n";
  CHECK_THAT(said_of_mesh(mesh),
             Catch::Matchers::Contains(
                 "edge (0, 1) has 1000 triangles: 0, 1, 2, 3, 4, 5, 6, 7, … (counted from 0)\n"));
}

TEST_CASE("a mesh whose squares overflow is not said to have no area") {
  CHECK(said_of_mesh(replaced(sheet, "v 1 1 0\n", "v 1 1e100 0\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj: vertex 4 (counted from 0) has a coordinate of 1e+100 m; at most "
        "1e+09 m can "
        "be computed with\n");
}

TEST_CASE("a pipe or a device in place of a mesh is refused without blocking") {
  const Scratch folder;
  REQUIRE(mkfifo((folder / "cloth.obj").c_str(), 0600) == 0);
  folder.write("e.yaml", experiment_with("cloth.obj"));
  CHECK(drape_with("check e.yaml", folder.path).err ==
        "error: e.yaml:2:8: cloth.obj: is a pipe or a device; give a file on a disk\n");
  std::filesystem::remove(folder / "cloth.obj");
  std::filesystem::create_symlink("/dev/zero", folder / "cloth.obj");
  CHECK(drape_with("check e.yaml", folder.path).err ==
        "error: e.yaml:2:8: cloth.obj: is a pipe or a device; give a file on a disk\n");
}
