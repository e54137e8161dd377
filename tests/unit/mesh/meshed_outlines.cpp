// Cloth of files that is meshed anew within its outline, and of patterns by the length of their edges.

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "core/app/experiment/cloth.h"
#include "core/numerics/collision_detection/components.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/meshes.h"
#include "tests/unit/mesh/cloth_scene.h"

using namespace drape;

namespace {

/// A panel as a CAD program writes it: a face of seven corners, with texture coordinates in millimetres.
const std::string panel =
    "v 0 0 0\nv 0.6 0 0\nv 0.6 0.4 0\nv 0.45 0.5 0\nv 0.3 0.42 0\nv 0.15 0.5 0\nv 0 0.4 0\n"
    "vt 0 0\nvt 600 0\nvt 600 400\nvt 450 500\nvt 300 420\nvt 150 500\nvt 0 400\n"
    "f 1/1 2/2 3/3 4/4 5/5 6/6 7/7\n";
constexpr double panel_area = 0.6 * 0.4 + 0.15 * 0.1 / 2 + 0.15 * (0.1 + 0.02) / 2 * 2 + 0.15 * 0.1 / 2;

/// The coarsest level of a cloth.
TriangleMesh cloth_of(const std::string& cloth) { return cloth_scene(cloth).scene->hierarchy.levels[0].rest; }

double area_of(const TriangleMesh& mesh) { return area_vectors(mesh).rowwise().norm().sum() / 2; }

Eigen::VectorXd edges_of(const TriangleMesh& mesh) {
  const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  return (mesh.vertices(topology.edges.col(0), Eigen::all) - mesh.vertices(topology.edges.col(1), Eigen::all))
      .rowwise()
      .norm();
}

}  // namespace

TEST_CASE("a panel of one face is meshed to the number of vertices or the edge length that is asked for") {
  const Scratch folder;
  folder.write("panel.obj", panel);
  const auto file = folder / "panel.obj";
  CHECK(cloth_of(cloth_in(file)).vertices.rows() == 7);
  for (const std::string key : {", vertices: 600", ", edge_length: 0.02"}) {
    CAPTURE(key);
    const TriangleMesh mesh = cloth_of(cloth_in(file, key));
    CHECK(mesh.vertices.rows() == Approx(key == ", vertices: 600" ? 600 : 800).epsilon(0.15));
    CHECK((mesh.vertices.col(2).array() == 0).all());
    CHECK(area_vectors(mesh).col(2).sum() / 2 == Approx(panel_area).epsilon(1e-12));
    const double most = key == ", vertices: 600" ? 0.04 : 0.032;
    CHECK(edges_of(mesh).maxCoeff() < most);
    CHECK(edges_of(mesh).minCoeff() > 0.005);
    const TriangleMesh written = read_mesh(file);
    for (const auto& corner : written.vertices.rowwise())
      CHECK((mesh.vertices.rowwise() - corner).rowwise().norm().minCoeff() < 1e-15);
    REQUIRE(mesh.uv.rows() == mesh.triangles.rows());
    for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
      for (int k = 0; k < 3; ++k)
        CHECK((mesh.uv.block<1, 2>(t, 2 * k) - 1000 * mesh.vertices.row(mesh.triangles(t, k)).head<2>())
                  .norm() < 1e-9);
  }
  const TriangleMesh one = cloth_of(cloth_in(file, ", vertices: 600")),
                     other = cloth_of(cloth_in(file, ", vertices: 600, seed: 2"));
  CHECK((one.vertices.rows() != other.vertices.rows() || one.vertices != other.vertices));
}

TEST_CASE(
    "a file's unit, axis and transform come before its outline is meshed, and the front stays in front") {
  const Scratch folder;
  folder.write("panel.obj", panel);
  for (const std::string keys :
       {"", ", up: y", ", rotate: [180, 0, 0]", ", rotate: [20, 30, 40]", ", unit: cm, scale: 5"}) {
    CAPTURE(keys);
    const TriangleMesh face = cloth_of(cloth_in(folder / "panel.obj", keys)),
                       mesh = cloth_of(cloth_in(folder / "panel.obj", keys + ", vertices: 200"));
    CHECK(mesh.vertices.rows() == Approx(200).epsilon(0.15));
    const Positions fronts = area_vectors(mesh);
    const Eigen::RowVector3d front = area_vectors(face).colwise().sum();
    CHECK((fronts.colwise().sum() - front).norm() < 1e-12 * front.norm());
    CHECK((fronts * front.transpose()).minCoeff() > 0);
    for (const auto& corner : face.vertices.rowwise())
      CHECK((mesh.vertices.rowwise() - corner).rowwise().norm().minCoeff() < 1e-14);
  }
}

TEST_CASE("parts and holes stay, each part meshed with the same edges, and directions of warp too") {
  TriangleMesh holed = grid({0.3, 0.3}, 4, 4, Diagonals::one_way);  // without the cell in its middle
  holed.triangles.row(8) = holed.triangles.row(16), holed.triangles.row(9) = holed.triangles.row(17);
  holed.triangles.conservativeResize(16, 3);
  TriangleMesh both = both_of(holed, grid({0.1, 0.2}, 2, 2, Diagonals::one_way), {0.5, 0, 0});
  both.warp = Positions::Zero(18, 3);
  both.warp.topRows(16).col(1).setOnes();
  both.warp.bottomRows(2).col(0).setOnes();
  const Scratch folder;
  write_mesh(folder / "parts.ply", both);
  const TriangleMesh mesh = cloth_of(cloth_in(folder / "parts.ply", ", vertices: 400"));
  CHECK(mesh.vertices.rows() == Approx(400).epsilon(0.15));
  CHECK(area_of(mesh) == Approx(0.08 + 0.02).epsilon(1e-12));
  const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  CHECK(components(topology).size() == 2);
  CHECK(mesh.vertices.rows() - topology.edges.rows() + mesh.triangles.rows() == 1);  // 2 parts, a hole
  Eigen::Index left = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const bool first = mesh.vertices(mesh.triangles(t, 0), 0) < 0.4;
    left += first;
    CHECK((mesh.warp.row(t) - Eigen::RowVector3d(!first, first, 0)).norm() < 1e-12);
  }
  CHECK(static_cast<double>(left) / static_cast<double>(mesh.triangles.rows()) == Approx(0.8).epsilon(0.1));
}

TEST_CASE("a finely sampled curve is divided by the edge length, not by its points") {
  const Scratch folder;
  write_mesh(folder / "disc.ply", disc(0.3, 6000));
  const TriangleMesh mesh = cloth_of(cloth_in(folder / "disc.ply", ", edge_length: 0.05"));
  const Eigen::VectorXd edges = edges_of(mesh);
  CHECK(edges.minCoeff() > 0.015);
  CHECK(edges.maxCoeff() < 0.09);
  CHECK(area_of(mesh) == Approx(0.09 * std::numbers::pi).epsilon(0.02));
}

TEST_CASE("discs and polygons have an edge length too") {
  const double spacing = 0.02;
  for (const std::string shape :
       {"shape: disc, radius: 0.2", "shape: polygon, loops: [{points: [0, 0, 0.3, 0, 0, 0.3]}]"}) {
    CAPTURE(shape);
    const Eigen::VectorXd edges = edges_of(cloth_of("{" + shape + ", edge_length: 0.02}"));
    CHECK(edges.mean() == Approx(spacing).epsilon(0.15));
  }
}

TEST_CASE("a panel of one face with a hole in it is meshed around the hole, one with very many corners too") {
  const Scratch folder;
  const auto file = folder / "face.obj";
  folder.write("face.obj",
               "v 0 0 0\nv .3 0 0\nv .3 .3 0\nv 0 .3 0\nv .1 .1 0\nv .1 .2 0\nv .2 .2 0\nv .2 .1 0\n"
               "f 1 2 3 4 1 5 6 7 8 5\n");
  CHECK(area_of(cloth_of(cloth_in(file))) == Approx(0.08));
  const TriangleMesh around = cloth_of(cloth_in(file, ", edge_length: 0.02"));
  CHECK(area_of(around) == Approx(0.08));
  CHECK((around.vertices.rowwise() - Eigen::RowVector3d(0.15, 0.15, 0)).rowwise().norm().minCoeff() > 0.0499);
  std::string circle, face = "f";
  for (int k = 0; k < 20000; ++k) {
    const double angle = 2 * std::numbers::pi * k / 20000;
    circle += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face += " " + std::to_string(k + 1);
  }
  folder.write("face.obj", circle + face + "\n");
  CHECK(area_of(cloth_of(cloth_in(file, ", edge_length: 0.1"))) == Approx(std::numbers::pi).epsilon(1e-2));
}

TEST_CASE("the number of vertices of a file that is meshed anew is known before they are made") {
  const Scratch folder;
  folder.write("panel.obj", panel);
  const Experiment e = experiment_from(cloth_experiment(cloth_in(folder / "panel.obj", ", vertices: 90")));
  CHECK((estimated_vertices(e.parameters) == std::vector<double>{90, 360}));
}
