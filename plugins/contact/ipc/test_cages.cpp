#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/cages.h"
#include "plugins/contact/ipc/ipc.h"
#include "tests/support/command.h"
#include "tests/support/meshes.h"

using namespace drape;
using namespace drape::ipc;
using Catch::Contains;

namespace {

/// A ball with horns and a box beside it: not convex, two components.
TriangleMesh horned() {
  TriangleMesh mesh = unit_sphere(3), box = unit_box();
  for (auto v : mesh.vertices.rowwise()) v *= 0.1 * (1 + 0.4 * std::sin(5 * v[0]) * std::sin(4 * v[1]));
  box.vertices *= 0.05;
  return both_of(mesh, box, {0.3, 0, 0});
}

ValidatedMesh placed(TriangleMesh mesh, double scale = 1, const Eigen::RowVector3d& move = {0, 0, 0}) {
  mesh.vertices = (scale * mesh.vertices).rowwise() + move;
  return *ValidatedMesh::of(mesh);
}

}  // namespace

TEST_CASE("ipc: cages enclose each other and have their obstacle's transform") {
  const Scratch folder;
  ObstacleParameters p;
  p.name = "horned";
  p.mesh = (folder / "horned.ply").string();
  write_mesh(p.mesh, horned());
  p.cages.count = 3;
  p.scale = 2;
  p.rotate = {10, 20, 30};
  p.translate = {1, 2, 3};
  const ObstacleMeshes meshes = ObstacleMeshes::of(p, 0);
  const Obstacle itself = Obstacle::of(p, 0, meshes);
  std::vector<Obstacle> levels;
  for (int l = 0; l < 5; ++l) levels.push_back(Obstacle::of(p, 0, meshes, l));
  CHECK(levels[0].name == "horned (cage 0)");
  CHECK(levels[3].name == "horned");
  for (const int l : {3, 4}) CHECK(levels[l].mesh().vertices == itself.mesh().vertices);
  for (int l = 0; l < 3; ++l) {
    INFO(l);
    const ValidatedMesh outer = placed(levels[l].mesh()), inner = placed(levels[l + 1].mesh());
    CHECK(enclosure_fault(outer, inner).empty());
    CHECK(!enclosure_fault(inner, outer).empty());
    if (l < 2) CHECK(levels[l].mesh().triangles.rows() < levels[l + 1].mesh().triangles.rows());
  }
  Ipc::Parameters moving;
  moving.obstacles = {p};
  moving.obstacles[0].mesh.clear();
  moving.obstacles[0].animation = {"a.ply"};
  CHECK_THROWS_WITH(Ipc(moving), Contains("\"horned\"") && Contains("without \"animation\""));
}

TEST_CASE("ipc: a cage that does not enclose its mesh is described") {
  const ValidatedMesh ball = placed(unit_sphere(2));
  const auto fault = [](const ValidatedMesh& cage, const ValidatedMesh& mesh, const std::string& why) {
    CHECK_THAT(enclosure_fault(cage, mesh), Contains(why));
  };
  CHECK(enclosure_fault(ball, placed(unit_box(), 0.5)).empty());
  fault(ball, placed(unit_box(), 0.5, {3, 0, 0}), "vertex 0 is outside");
  fault(ball, placed(unit_box(), 0.5, {0.9, 0, 0}), " intersects that one's triangle ");
  fault(placed(unit_box(), 0.5), ball, "vertex 0 is outside");
  fault(placed(grid({1, 1}, 3, 3, Diagonals::one_way)), ball, "not closed");
  // One component inside, one outside.
  fault(placed(unit_sphere(3), 0.2), placed(horned()), "is outside");
  // A cage may not touch what it encloses.
  CHECK(!enclosure_fault(placed(unit_box()), placed(unit_box(), 0.5, {0.25, 0, 0})).empty());
}
