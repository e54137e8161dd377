#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/bound_ipc.h"
#include "tests/support/command.h"
#include "tests/support/meshes.h"

using namespace drape;
using namespace drape::ipc;
using Catch::Contains;

namespace {

/// A ball with horns and a box beside it: not convex, two components.
TriangleMesh horned() {
  TriangleMesh mesh = unit_sphere(3);
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    mesh.vertices.row(v) *=
        0.1 * (1 + 0.4 * std::sin(5 * mesh.vertices(v, 0)) * std::sin(4 * mesh.vertices(v, 1)));
  TriangleMesh box = unit_box();
  box.vertices *= 0.05;
  return both_of(mesh, box, {0.3, 0, 0});
}

ObstacleParameters with_cages(const std::string& file, int count) {
  ObstacleParameters p;
  p.name = "horned";
  p.mesh = file;
  p.cages.count = count;
  return p;
}

ValidatedMesh validated(const TriangleMesh& mesh) { return *ValidatedMesh::of(mesh); }

ValidatedMesh placed(ValidatedMesh mesh, double scale, const Eigen::RowVector3d& move) {
  mesh.mesh.vertices = (scale * mesh.mesh.vertices).rowwise() + move;
  return mesh;
}

}  // namespace

TEST_CASE("ipc: cages enclose each other and have their obstacle's transform") {
  const Scratch folder;
  const std::string file = (folder / "horned.ply").string();
  write_mesh(file, horned());
  ObstacleParameters p = with_cages(file, 3);
  p.scale = 2;
  p.rotate = {10, 20, 30};
  p.translate = {1, 2, 3};
  const ObstacleMeshes meshes = ObstacleMeshes::of(p, 0);
  std::vector<Obstacle> levels;
  for (int l = 0; l < 5; ++l) levels.push_back(Obstacle::of(p, 0, meshes, l));
  const Obstacle itself = Obstacle::of(p, 0, meshes);
  CHECK(levels[0].name == "horned (cage 0)");
  CHECK(levels[3].name == "horned");
  CHECK(levels[3].mesh.vertices == itself.mesh.vertices);
  CHECK(levels[4].mesh.vertices == itself.mesh.vertices);
  for (int l = 0; l < 3; ++l) {
    INFO(l);
    CHECK(enclosure_fault(validated(levels[l].mesh), validated(levels[l + 1].mesh)).empty());
    CHECK(!enclosure_fault(validated(levels[l + 1].mesh), validated(levels[l].mesh)).empty());
    if (l < 2) CHECK(levels[l].mesh.triangles.rows() < levels[l + 1].mesh.triangles.rows());
  }
}

TEST_CASE("ipc: a cage that does not enclose its mesh is described") {
  const ValidatedMesh ball = validated(unit_sphere(2)), box = validated(unit_box());
  CHECK(enclosure_fault(ball, placed(box, 0.5, {0, 0, 0})).empty());
  CHECK_THAT(enclosure_fault(ball, placed(box, 0.5, {3, 0, 0})), Contains("vertex 0 is outside"));
  CHECK_THAT(enclosure_fault(ball, placed(box, 0.5, {0.9, 0, 0})),
             Contains(" intersects that one's triangle "));
  CHECK_THAT(enclosure_fault(placed(box, 0.5, {0, 0, 0}), ball), Contains("vertex 0 is outside"));
  CHECK_THAT(enclosure_fault(validated(grid({1, 1}, 3, 3, Diagonals::one_way)), ball),
             Contains("not closed"));
  // One component inside, one outside.
  CHECK_THAT(enclosure_fault(placed(validated(unit_sphere(3)), 0.2, {0, 0, 0}), validated(horned())),
             Contains("is outside"));
  // A cage may not touch what it encloses.
  CHECK(!enclosure_fault(box, placed(box, 0.5, {0.25, 0, 0})).empty());
}

TEST_CASE("ipc: a level of the cloth collides with the cage of its index") {
  const Scratch folder;
  const std::string file = (folder / "horned.ply").string();
  write_mesh(file, horned());
  Ipc::Parameters p;
  p.obstacles = {with_cages(file, 1)};
  const Ipc model(p);
  const TriangleMesh cloth = grid({0.1, 0.1}, 4, 4, Diagonals::one_way);
  const auto on = [&](int level) { return model.bind(Level::of(level, cloth), Material())->obstacles()[0]; };
  const TriangleMesh itself = horned();
  CHECK(on(1).vertices == itself.vertices);
  CHECK(on(5).vertices == itself.vertices);
  CHECK(enclosure_fault(validated(on(0)), validated(itself)).empty());
  p.obstacles[0].animation = {"a.ply"};
  p.obstacles[0].mesh.clear();
  CHECK_THROWS_WITH(Ipc(p), Contains("\"horned\"") && Contains("without \"animation\""));
}
