#include "core/numerics/mesh_files/file_coordinates.h"

#include <catch2/catch.hpp>

#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/refusal.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Metres with z up in other coordinates, as a program would write them.
TriangleMesh written_in(TriangleMesh mesh, double units_per_metre, bool y_up) {
  mesh.vertices *= units_per_metre;
  if (!y_up) return mesh;
  mesh.vertices.col(1).swap(mesh.vertices.col(2));
  mesh.vertices.col(2) = -mesh.vertices.col(2);
  return mesh;
}

/// A bump above a sheet of 0.3 × 0.2 m. It is not symmetric, so that each vertex of a finer level has one
/// nearest triangle.
TriangleMesh bump() {
  TriangleMesh mesh = grid({0.3, 0.2}, 4, 3, Diagonals::one_way);
  mesh.vertices.row(5) += Eigen::RowVector3d(0.011, 0.007, 0.05);
  return mesh;
}

std::string experiment(const std::string& cloth, const std::string& start, const std::string& more = "") {
  return "name: coordinates\ncloth: " + cloth + "\nlevels: 2\nstart: " + start +
         "\nenergies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n" + more;
}

/// Whether both scenes have the same rest shapes and starts, but for round-off.
bool are_alike(const Scene& a, const Scene& b) {
  bool alike = true;
  for (std::size_t l = 0; l < a.starts.size(); ++l)
    alike = alike && a.starts[l].isApprox(b.starts[l], 1e-14) &&
            a.hierarchy.levels[l].rest.vertices.isApprox(b.hierarchy.levels[l].rest.vertices, 1e-14);
  return alike;
}

}  // namespace

TEST_CASE("Coordinates of a file become metres with z up, each the nearest double") {
  Positions x(1, 3);
  x << 123, -7, 310;
  FileCoordinates{"mm", "z"}.convert(x);
  CHECK(x == Eigen::RowVector3d(0.123, -0.007, 0.31));
  FileCoordinates{"m", "y"}.convert(x);
  CHECK(x == Eigen::RowVector3d(0.123, -0.31, -0.007));
  x << 3, 2, 1;
  FileCoordinates{"cm", "z"}.convert(x);
  CHECK(x == Eigen::RowVector3d(0.03, 0.02, 0.01));
  x << 10, 1, 0;
  FileCoordinates{"inch", "z"}.convert(x);
  CHECK(x == Eigen::RowVector3d(0.254, 0.0254, 0));
  FileCoordinates().convert(x);
  CHECK(x == Eigen::RowVector3d(0.254, 0.0254, 0));
}

TEST_CASE("The cloth's file and the start's are read in the unit and by the axis of the cloth") {
  const Scratch folder;
  TriangleMesh start = bump();
  start.vertices.col(2).array() += 0.4;
  write_mesh(folder / "rest.ply", bump());
  write_mesh(folder / "start.ply", start);
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const Solved metres = scene_from(
      experiment("{shape: file, file: " + at("rest.ply") + "}", "{file: " + at("start.ply") + "}"));
  for (const auto& [unit, factor] : {std::pair("mm", 1000.), {"cm", 100.}, {"inch", 1 / 0.0254}})
    for (const bool y_up : {false, true}) {
      INFO(unit << ", y up: " << y_up);
      write_mesh(folder / "other_rest.ply", written_in(bump(), factor, y_up));
      write_mesh(folder / "other_start.ply", written_in(start, factor, y_up));
      const std::string keys = std::string(", unit: ") + unit + ", up: " + (y_up ? "y" : "z") + "}";
      const std::string cloth = "{shape: file, file: " + at("other_rest.ply") + keys;
      CHECK(are_alike(*metres.scene,
                      *scene_from(experiment(cloth, "{file: " + at("other_start.ply") + "}")).scene));
      // A start that drape wrote is in metres with z up, whatever the cloth's file is in.
      CHECK(
          are_alike(*metres.scene,
                    *scene_from(experiment(cloth, "{file: " + at("start.ply") + ", unit: m, up: z}")).scene));
    }
}

TEST_CASE("A cloth's file is scaled and rotated at rest, so its energy is that of the same cloth") {
  const Scratch folder;
  TriangleMesh start = bump();
  start.vertices.col(0) *= 1.1;
  write_mesh(folder / "rest.ply", bump());
  write_mesh(folder / "start.ply", start);
  const std::string file = "{shape: file, file: " + (folder / "rest.ply").string();
  const std::string from = "{file: " + (folder / "start.ply").string() + "}";
  const Solved plain = scene_from(experiment(file + "}", from));
  const Solved turned = scene_from(experiment(file + ", rotate: [90, 20, 30]}", from));
  const Eigen::Matrix3d rotation = rotation_matrix({90, 20, 30});
  CHECK(turned.rest().isApprox(plain.rest() * rotation.transpose(), 1e-12));
  CHECK(turned.scene->starts[1].isApprox(plain.scene->starts[1], 1e-13));
  const auto energy = [](const Solved& s) { return s.model().energy(s.scene->starts[1]); };
  CHECK(energy(plain) > 0);
  CHECK(energy(turned) == Approx(energy(plain)).epsilon(1e-9));
  // First the scale, then the rotation.
  const Solved both = scene_from(experiment(file + ", scale: 2, rotate: [90, 0, 0]}", "{}"));
  CHECK(both.scene->hierarchy.levels[0].rest.vertices.isApprox(
      2 * bump().vertices * rotation_matrix({90, 0, 0}).transpose(), 1e-12));
}

TEST_CASE("A start in the rest shape's own file is without strain on every level, though Loop moves it") {
  const Scratch folder;
  write_mesh(folder / "rest.ply", random_triangulation({0.3, 0.2}, 40, 3));
  const std::string file = "file: " + (folder / "rest.ply").string(), cloth = "{shape: file, " + file + "}";
  const Solved plain = scene_from(experiment(cloth, "{}")),
               own = scene_from(experiment(cloth, "{" + file + "}"));
  for (std::size_t l = 0; l < plain.scene->starts.size(); ++l) {
    CHECK(own.scene->starts[l].isApprox(plain.scene->starts[l], 1e-12));
    CHECK(own.scene->placed[l].isApprox(plain.scene->placed[l], 1e-12));  // where pins hold
  }
}

TEST_CASE("An obstacle's files are read in its unit and by its axis") {
  const Scratch folder;
  TriangleMesh ball = unit_sphere(1);
  ball.vertices *= 0.1;
  ball.vertices.col(2).array() -= 0.3;
  TriangleMesh moved = ball;
  moved.vertices.col(0).array() += 0.2;
  write_mesh(folder / "ball.ply", written_in(ball, 1000, true));
  write_mesh(folder / "moved.ply", written_in(moved, 1000, true));
  const auto obstacle = [&](const std::string& keys) {
    const Solved s =
        scene_from(experiment("{vertices: 9}", "{}", "contact: ipc\nobstacles: [{" + keys + "}]\n"));
    return obstacles_of(s.model().contacts()).at(0).vertices;
  };
  const std::string mesh = (folder / "ball.ply").string(), other = (folder / "moved.ply").string();
  CHECK(obstacle("mesh: " + mesh + ", unit: mm, up: y").isApprox(ball.vertices, 1e-14));
  CHECK(obstacle("animation: [" + mesh + ", " + other + "], unit: mm, up: y, frame: 1")
            .isApprox(moved.vertices, 1e-14));
  CHECK(obstacle("mesh: " + mesh + ", unit: mm, up: y, scale: 2, rotate: [0, 0, 90], translate: [0, 0, -1]")
            .isApprox(((2 * ball.vertices * rotation_matrix({0, 0, 90}).transpose()).rowwise() +
                       Eigen::RowVector3d(0, 0, -1))
                          .eval(),
                      1e-14));
}

TEST_CASE("A polygon's points are read in its unit") {
  const auto rest = [](const std::string& keys) {
    return scene_from(experiment("{shape: polygon, vertices: 30, " + keys + "}", "{}")).rest();
  };
  const Positions metres = rest("loops: [{points: [0, 0, 0.25, 0, 0.25, 0.3, 0, 0.2]}]");
  CHECK(rest("unit: mm, loops: [{points: [0, 0, 250, 0, 250, 300, 0, 200]}]").isApprox(metres, 1e-12));
  // A mesh of it that drape wrote is in metres all the same.
  const Scratch folder;
  const std::string cloth =
      "{shape: polygon, vertices: 30, unit: mm, loops: [{points: [0, 0, 250, 0, 250, 300, 0, 200]}]}";
  const Solved plain = scene_from(experiment(cloth, "{}"));
  write_mesh(folder / "start.ply", plain.scene->hierarchy.levels[0].rest);
  const Solved own = scene_from(experiment(cloth, "{file: " + (folder / "start.ply").string() + "}"));
  CHECK(own.scene->starts[0].isApprox(plain.scene->starts[0], 1e-12));
}

TEST_CASE("Units and axes without a file are refused") {
  const auto refusal = [](const std::string& cloth, const std::string& start, const std::string& more = "") {
    return refusal_of([&] { scene_from(experiment(cloth, start, more)); });
  };
  for (const char* key : {"unit: mm", "up: y", "scale: 2", "rotate: [0, 0, 9]"})
    CHECK_THAT(refusal(std::string("{shape: square, ") + key + "}", "{}"), Catch::Contains(":2:"));
  CHECK(refusal("{shape: square, unit: m, up: z, scale: 1}", "{}") == "");  // a saved config has them
  CHECK_THAT(refusal("{shape: square}", "{up: y}"),
             Catch::Contains(":4:") &&
                 Catch::Contains("\"up\" in start says how its \"file\" is read, and it has none"));
  CHECK_THAT(refusal("{shape: square, vertices: 9}", "{}",
                     "contact: ipc\nobstacles: [{meshed_shape: box, unit: mm, translate: [0, 0, -3]}]\n"),
             Catch::Contains("\"unit\" and \"up\" say how a mesh file is read; a meshed_shape is in metres"));
  CHECK_THAT(refusal("{shape: file, file: a.obj, unit: ft}", "{}"),
             Catch::Contains(R"("unit" must be "mm", "cm", "m" or "inch", not "ft")"));
}
