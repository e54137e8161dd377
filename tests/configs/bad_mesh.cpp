// What the command says to a cloth from a bad mesh file: the file, and the line or the element.

#include <sys/stat.h>

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
  CHECK(said_of_mesh("solid", "cloth.3ds") ==
        "error: in/e.yaml:2:8: in/cloth.3ds: unknown mesh format '.3ds'; known are .obj, .off, .ply, .stl\n");
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
  const std::string file = "error: in/e.yaml:2:8: in/cloth.obj: ";
  CHECK(said_of_mesh(replaced(sheet, "f 5 9 8\n", "f 5 8 9\n")) ==
        file +
            "2 edges run in the same direction in both triangles: (4, 7) in triangles 4, 7, (4, 8) in "
            "triangles "
            "6, 7 (counted from 0); turn one side over, so that all triangles have the same front side\n");
  CHECK(said_of_mesh("") == file + "is empty\n");
  CHECK(said_of_mesh("v 0 0 0\n") ==
        file + "the mesh has no triangles\n" + file +
            "the mesh is 0 m across; at least 1e-09 m can be computed with\n" + file +
            "1 vertex belongs to no triangle: 0 (counted from 0); remove them\n");
  CHECK(said_of_mesh(sheet + "v 0 0 1\nf 1 10 5\n") ==
        file +
            "1 edge has more than two triangles: (0, 4) in triangles 0, 1, 8 (counted from 0); a sheet has "
            "one or "
            "two at each edge: remove those between its sides, or cut it there\n");
  CHECK(said_of_mesh(replaced(sheet, "f 5 9 8\n", "f 5 9 9\n")) ==
        file + "1 triangle repeats a vertex: 7 (4, 8, 8) (counted from 0); remove them\n");
  CHECK(said_of_mesh(replaced(sheet, "v 2 2 0\n", "v 1 1 0\n")) ==
        file +
            "2 triangles have no area: 6 (4, 5, 8), 7 (4, 8, 7) (counted from 0); move their vertices apart, "
            "or "
            "remove them\n");
  CHECK(said_of_mesh(sheet + "f 1 2 5\n") == file +
                                                 "1 triangle has the same vertices as another: 8 (0, 1, 4) "
                                                 "as 0 (counted from 0); remove one of each "
                                                 "two\n");
  CHECK(said_of_mesh(sheet + "v 5 5 5\n") ==
        file + "1 vertex belongs to no triangle: 9 (counted from 0); remove them\n");
}

TEST_CASE("all faults of a mesh are listed at once") {
  const std::string said =
      said_of_mesh(sheet + "v 5 5 5\nf 1 2 5\nf 1 1 2\nv 0 0 1\nf 1 11 5\nv 0 0 2\nv 1 0 2\nf 9 12 13\n");
  for (const std::string fault :
       {"1 vertex belongs to no triangle: 9", "1 triangle repeats a vertex: 9",
        "1 triangle has the same vertices as another: 8 ", "1 edge has more than two triangles: (0, 4)",
        "1 vertex joins separate fans of triangles: 8 of 2 fans"})
    CHECK_THAT(said, Catch::Matchers::Contains(fault));
  CHECK(std::count(said.begin(), said.end(), '\n') == 5);
}

TEST_CASE("a cushion that is flat at rest is valid") {
  std::string cushion;  // the sheet's border, its middle twice
  for (const char* middle : {"1 1 0", "1 1 0"}) cushion += "v " + std::string(middle) + "\n";
  cushion += "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";
  for (int k = 0; k < 4; ++k) {
    const std::string a = std::to_string(3 + k), b = std::to_string(3 + (k + 1) % 4);
    cushion += "f 1 " + a + " " + b + "\nf 2 " + b + " " + a + "\n";
  }
  const Scratch folder;
  folder.write("cloth.obj", cushion);
  folder.write("e.yaml", experiment_with("cloth.obj"));
  const Ended ended = drape_with("check e.yaml --set contact=[] --set refiner=midpoint", folder.path);
  INFO(ended.err);
  CHECK(ended.exit_code == 0);
}

TEST_CASE("bending for flat rest shapes names where a mesh file is curved") {
  const std::string bent = replaced(sheet, "v 1 1 0\n", "v 1 1 0.5\n");
  CHECK(said_of_mesh(bent, "cloth.obj", "--set 'energies=[neo_hookean, quadratic_bending, gravity]'") ==
        "error: --set energies: quadratic_bending: the rest shape of level 0 is not flat (angle 0.420534 at "
        "the edge of vertices 1 and 4); use hinge\n");
}

TEST_CASE("few faults are listed for any number in a mesh") {
  std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0";
  for (int k = 0; k < 200000; ++k) mesh += "\nf 1 2 3";
  const std::string said = said_of_mesh(mesh + "\n");
  CHECK(said.size() < 10000);
  CHECK_THAT(said, Catch::Matchers::Contains(
                       "in/cloth.obj: 199999 triangles have the same vertices as another: 1 "));

  mesh = "v 0 0 0\nv 1 0 0\n";
  for (int k = 0; k < 1000; ++k)
    mesh += "v " + std::to_string(k) + " 1 " + std::to_string(k) + "\nf 1 2 -1\n";
  CHECK_THAT(said_of_mesh(mesh),
             Catch::Matchers::Contains("1 edge has more than two triangles: (0, 1) in triangles 0, 1, 2, 3, "
                                       "4, 5, 6, 7, … (counted from 0); "));
}

TEST_CASE("a mesh whose squares overflow is not said to have no area") {
  CHECK(said_of_mesh(replaced(sheet, "v 1 1 0\n", "v 1 1e100 0\n")) ==
        "error: in/e.yaml:2:8: in/cloth.obj: 1 vertex has too large a coordinate: 4 with 1e+100 m (counted "
        "from "
        "0); at most 1e+09 m can be computed with: is the file in metres?\n");
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
