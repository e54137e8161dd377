// What the command says to a bad mesh file of a cloth or an obstacle: the file, and the line or the element.
// And what it keeps of a good one.

#include <algorithm>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/configs/runs.h"
#include "tests/support/glb.h"

using namespace drape;

namespace {

/// A square of 3 × 3 vertices, 0 to 8 by rows, in 8 triangles; vertices are lines 1 to 9, faces 10 to 17.
const std::string sheet =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n"
    "f 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\nf 4 5 8\nf 4 8 7\nf 5 6 9\nf 5 9 8\n";

std::string experiment_with(const std::string& mesh) {
  return replaced(small_experiment(), "{shape: square, side: 1, columns: 6, rows: 6}",
                  "{shape: file, file: " + mesh + "}");
}

}  // namespace

TEST_CASE("a valid mesh file runs, and its results can be run again from their own config") {
  // Coordinates are converted once, though both results folders name a file.
  const std::pair<std::string, std::string> cases[] = {
      {"cloth.obj", "start: {scale: [0.9, 0.9, 1]"},
      {"cloth.obj, unit: inch, up: y, scale: 20, rotate: [0, 0, 90]",
       "start: {file: cloth.obj, scale: [19, 20, 19]"},
      {"cloth.obj, edge_length: 0.3", "start: {scale: [0.9, 0.9, 1]"}};
  for (const auto& [cloth, start] : cases) {
    const Scratch folder(replaced(experiment_with(cloth), cases[0].second, start));
    folder.write("cloth.obj", sheet);
    run_into("first", folder, "--threads 1 --method pcs");
    fs::remove(folder / "cloth.obj");
    drape_ends("run first/config.yaml --quiet --no-report --measure --threads 1 --method pcs --out second",
               folder);
    check_same_files(folder / "first", folder / "second",
                     {"config.yaml", "rest/l0.ply", "levels/pcs_l0.ply", "levels/pcs_l1.ply"});
  }
}

TEST_CASE("a malformed mesh file is found beside its config, and named with its line") {
  const Scratch folder;
  fs::create_directory(folder / "in");
  folder.write("in/e.yaml", experiment_with("cloth.obj"));
  folder.write("in/cloth.obj", replaced(sheet, "v 1 1 0\n", "v 1 one 0\n"));
  CHECK(refused(folder, "check in/e.yaml") ==
        "error: in/e.yaml:2:8: in/cloth.obj:5: 'one' is not a number\n");
}

TEST_CASE("panels that nothing joins are named: seams that stand twice, and the lines that sew elsewhere") {
  const std::string panel = "v 2 0 0\nv 3 0 0\nv 2 1 0\nv 3 1 0\nf 10 11 13 12\n";
  const std::string scene =
      "name: panels\ncloth: {shape: file, file: cloth.obj}\nlevels: 1\n"
      "energies: [neo_hookean, hinge, gravity]\ncontact: ipc\nmethods: {newton: {}}\n";
  const std::string weld =
      "2 border vertices lie on another one, as 9 on 2 (counted from 0) at (2, 0, 0): the "
      "cloth is not joined there; if it should be, weld them in the file\n";
  const Scratch folder(scene);
  folder.write("cloth.obj", sheet + panel);
  const std::string said = refused_alike(folder);
  CHECK_THAT(said, Contains("the start of level 0 touches: ") && Contains("error: e.yaml:2:8: " + weld) &&
                       !Contains("change the start"));
  CHECK_THAT(refused_alike(folder, "--allow-start-repair"), Contains(weld));
  folder.write("e.yaml", replaced(scene, "contact: ipc\n", ""));
  CHECK_THAT(drape_ends("check e.yaml", folder).err, Contains("warning: e.yaml:2:8: " + weld));

  folder.write("e.yaml", scene);
  folder.write("cloth.obj", sheet + replaced(replaced(panel, "v 2 0", "v 2.5 0"), "v 2 1", "v 2.5 1") +
                                "l 3 10\nl 6 12 13\n");
  CHECK_THAT(drape_ends("check e.yaml", folder).err,
             Contains("warning: e.yaml:2:8: 2 lines between vertices (`l` in an OBJ file, `edge` in a PLY) "
                      "are ignored: drape sews "
                      "nothing; to join panels, have them share the vertices of the seam\n"));
}

TEST_CASE("texture coordinates of the cloth's file reach every export, seams included") {
  const Scratch folder;
  // Upright, in the plane y = 0, with a seam in the middle and a mirrored right half.
  const double side = 0.4;
  const auto expected = [&](const TriangleMesh& rest, Eigen::Index t, int k) {
    const auto corner = [&](int i) { return rest.vertices.row(rest.triangles(t, i)); };
    const bool left = (corner(0).x() + corner(1).x() + corner(2).x()) / 3 < side / 2;
    const double x = corner(k).x(), z = corner(k).z();
    return Eigen::RowVector2d((left ? x : side - x) / side, z / side + (left ? 0 : 0.25));
  };
  TriangleMesh cloth = grid({side, side}, 9, 9, Diagonals::one_way);
  cloth.vertices.col(1).swap(cloth.vertices.col(2));
  cloth.uv.resize(cloth.triangles.rows(), 6);
  for (Eigen::Index t = 0; t < cloth.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) cloth.uv.block<1, 2>(t, 2 * k) = expected(cloth, t, k);
  write_mesh(folder / "upright.obj", cloth);
  folder.write("e.yaml",
               "name: banner\ncloth: {shape: file, file: upright.obj}\nlevels: 3\n"
               "pins: [{region: box, lower: [-1, -1, 0.399], upper: [1, 1, 1]}]\n"
               "energies: [neo_hookean, hinge, gravity]\nrefiner: midpoint\n"
               "newton: {force_tolerance: 1}\nmethods: {pcs: {}}\n");
  run_into("out", folder, "-j 1");
  const auto exported_to = [&](const std::string& name) {
    drape_ends("export out --to " + name, folder);
    return folder / name;
  };
  const TriangleMesh rest = read_mesh(folder / "out/rest/l2.ply");
  const Positions state = read_mesh(folder / "out/levels/pcs_l2.ply").vertices;
  double most = 0;
  for (const std::string name : {"out.obj", "out.ply"}) {
    const TriangleMesh mesh = read_mesh(exported_to(name));
    CHECK((mesh.vertices == state));
    REQUIRE(mesh.uv.rows() == rest.triangles.rows());
    for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
      for (int k = 0; k < 3; ++k)
        most = std::max(most, (mesh.uv.block<1, 2>(t, 2 * k) - expected(rest, t, k)).norm());
  }
  const Glb glb(text_of(exported_to("out.glb")));
  const auto& primitive = glb.json["meshes"][2]["primitives"][0];
  CHECK(glb.json["meshes"][2]["name"] == "banner level 2");
  const std::vector<float> uv = glb.floats(primitive["attributes"]["TEXCOORD_0"]),
                           x = glb.floats(primitive["attributes"]["POSITION"]);
  const std::vector<std::uint32_t> corners = glb.indices(primitive["indices"]);
  CHECK(x.size() == static_cast<std::size_t>(state.size()) + 3 * 33);  // a seam of 32 edges
  REQUIRE(corners.size() == static_cast<std::size_t>(rest.triangles.size()));
  for (Eigen::Index t = 0; t < rest.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::size_t c = corners[3 * t + k];
      const Eigen::RowVector2d here(uv[2 * c], 1 - uv[2 * c + 1]);
      most = std::max(most, (here - expected(rest, t, k)).norm());
      const auto p = state.row(rest.triangles(t, k));
      most = std::max({most, std::abs(x[3 * c] - p.x()), std::abs(x[3 * c + 1] - p.z())});
    }
  CHECK(most < 2e-6);

  // The results folder's experiment reads rest/l0.ply: the same again.
  drape_ends("run out/config.yaml -o again -j 1 -q --no-report --measure", folder);
  check_same_files(folder / "again", folder / "out", {"rest/l0.ply", "rest/l2.ply", "levels/pcs_l2.ply"});
}
