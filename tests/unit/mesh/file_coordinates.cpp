#include "core/numerics/mesh_files/file_coordinates.h"

#include <catch2/catch.hpp>

#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/unit/mesh/cloth_scene.h"

using namespace drape;

namespace {

/// Metres with z up in other coordinates, as a program would write them.
TriangleMesh written_in(TriangleMesh mesh, double units_per_metre, bool y_up) {
  mesh.vertices *= units_per_metre;
  if (!y_up) return mesh;
  mesh.vertices.col(1).swap(mesh.vertices.col(2));
  mesh.vertices.col(2) *= -1;
  return mesh;
}

/// A bump above a sheet of 0.3 × 0.2 m. It is not symmetric, so that each vertex of a finer level has one
/// nearest triangle.
TriangleMesh bump() {
  TriangleMesh mesh = grid({0.3, 0.2}, 4, 3, Diagonals::one_way);
  mesh.vertices.row(5) += Eigen::RowVector3d(0.011, 0.007, 0.05);
  return mesh;
}

/// The key of a start in a file, with these further ones.
std::string start_in(const std::filesystem::path& file, const std::string& more = "") {
  return "start: {file: " + file.string() + more + "}\n";
}

/// Both scenes must have the same rest shapes, starts and places where pins hold, but for round-off.
void check_alike(const Solved& a, const Solved& b, double tolerance = 1e-14) {
  for (std::size_t l = 0; l < 2; ++l) {
    const Level &level = a.scene->hierarchy.levels[l], &other = b.scene->hierarchy.levels[l];
    CHECK(level.rest.vertices.isApprox(other.rest.vertices, tolerance));
    CHECK(a.scene->starts[l].isApprox(b.scene->starts[l], tolerance));
    CHECK(a.scene->placed[l].isApprox(b.scene->placed[l], tolerance));
  }
}

}  // namespace

TEST_CASE("Coordinates of a file become metres with z up, each the nearest double") {
  const auto check = [](const FileCoordinates& coordinates, const Eigen::RowVector3d& written,
                        const Eigen::RowVector3d& metres) {
    Positions x = written;
    coordinates.convert(x);
    CHECK(x == metres);
  };
  check({"mm", "z"}, {123, -7, 310}, {0.123, -0.007, 0.31});
  check({"m", "y"}, {0.123, -0.007, 0.31}, {0.123, -0.31, -0.007});
  check({"inch", "z"}, {10, 1, 0}, {0.254, 0.0254, 0});
}

TEST_CASE("The cloth's file and the start's are read in the unit and by the axis of the cloth") {
  const Scratch folder;
  TriangleMesh start = bump();
  start.vertices.col(2).array() += 0.4;
  write_mesh(folder / "rest.ply", bump());
  write_mesh(folder / "start.ply", start);
  const Solved metres = cloth_scene(cloth_in(folder / "rest.ply"), start_in(folder / "start.ply"));
  for (const auto& [unit, factor] : {std::pair("mm", 1000.), {"cm", 100.}, {"inch", 1 / 0.0254}})
    for (const bool y_up : {false, true}) {
      INFO(unit << ", y up: " << y_up);
      write_mesh(folder / "other_rest.ply", written_in(bump(), factor, y_up));
      write_mesh(folder / "other_start.ply", written_in(start, factor, y_up));
      const std::string cloth =
          cloth_in(folder / "other_rest.ply", std::string(", unit: ") + unit + ", up: " + (y_up ? "y" : "z"));
      check_alike(metres, cloth_scene(cloth, start_in(folder / "other_start.ply")));
      // A start that drape wrote is in metres with z up, whatever the cloth's file is in.
      check_alike(metres, cloth_scene(cloth, start_in(folder / "start.ply", ", unit: m, up: z")));
    }
}

TEST_CASE("A cloth's file is scaled and rotated at rest, so its energy is that of the same cloth") {
  const Scratch folder;
  const auto file = folder / "rest.ply";
  TriangleMesh start = bump();
  start.vertices.col(0) *= 1.1;
  write_mesh(file, bump());
  write_mesh(folder / "start.ply", start);
  const std::string from = start_in(folder / "start.ply");
  const Solved plain = cloth_scene(cloth_in(file), from),
               turned = cloth_scene(cloth_in(file, ", rotate: [90, 20, 30]"), from);
  CHECK(turned.rest().isApprox(plain.rest() * rotation_matrix({90, 20, 30}).transpose(), 1e-12));
  CHECK(turned.scene->starts[1].isApprox(plain.scene->starts[1], 1e-13));
  const auto energy = [](const Solved& s) { return s.model().energy(s.scene->starts[1]); };
  CHECK(energy(plain) > 0);
  CHECK(energy(turned) == Approx(energy(plain)).epsilon(1e-9));
  // First the scale, then the rotation.
  CHECK(cloth_scene(cloth_in(file, ", scale: 2, rotate: [90, 0, 0]"))
            .scene->hierarchy.levels[0]
            .rest.vertices.isApprox(2 * bump().vertices * rotation_matrix({90, 0, 0}).transpose(), 1e-12));
}

TEST_CASE("An obstacle's files are read in its unit and by its axis") {
  const Scratch folder;
  TriangleMesh ball = unit_sphere(1);
  ball.vertices = (0.1 * ball.vertices).rowwise() - Eigen::RowVector3d(0, 0, 0.3);
  TriangleMesh moved = ball;
  moved.vertices.col(0).array() += 0.2;
  write_mesh(folder / "ball.ply", written_in(ball, 1000, true));
  write_mesh(folder / "moved.ply", written_in(moved, 1000, true));
  const auto obstacle = [&](const std::string& keys) {
    const Solved s =
        cloth_scene("{vertices: 9}", "contact: ipc\nobstacles: [{" + keys + ", unit: mm, up: y}]\n");
    return s.model().obstacles().at(0).vertices;
  };
  const std::string mesh = (folder / "ball.ply").string(), other = (folder / "moved.ply").string();
  CHECK(obstacle("mesh: " + mesh).isApprox(ball.vertices, 1e-14));
  CHECK(obstacle("animation: [" + mesh + ", " + other + "], frame: 1").isApprox(moved.vertices, 1e-14));
  const Positions turned = 2 * ball.vertices * rotation_matrix({0, 0, 90}).transpose();
  CHECK(obstacle("mesh: " + mesh + ", scale: 2, rotate: [0, 0, 90], translate: [0, 0, -1]")
            .isApprox((turned.rowwise() + Eigen::RowVector3d(0, 0, -1)).eval(), 1e-14));
}

TEST_CASE("A polygon's points are read in its unit, its rest shape as a start in metres without strain") {
  const std::string polygon = "{shape: polygon, vertices: 30, ",
                    cloth = polygon + "unit: mm, loops: [{points: [0, 0, 250, 0, 250, 300, 0, 200]}]}";
  const Solved plain = cloth_scene(cloth);
  check_alike(plain, cloth_scene(polygon + "loops: [{points: [0, 0, 0.25, 0, 0.25, 0.3, 0, 0.2]}]}"), 1e-12);
  const Scratch folder;
  write_mesh(folder / "start.ply", plain.scene->hierarchy.levels[0].rest);
  check_alike(plain, cloth_scene(cloth, start_in(folder / "start.ply")), 1e-12);  // though Loop moves it
}

TEST_CASE("Units and axes that change nothing need no file, since a saved config has them") {
  CHECK_NOTHROW(cloth_scene("{shape: square, unit: m, up: z, scale: 1}"));
}
