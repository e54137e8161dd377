// Obstacles whose meshes no cloth could have: what is dropped, what is kept, and how contact takes it.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/kernel/plugin/refused_parameters.h"
#include "core/numerics/contact/surface_contacts.h"
#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/repair.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/ipc.h"
#include "tests/support/command.h"
#include "tests/support/meshes.h"
#include "tests/support/near_surface.h"
#include "tests/support/random.h"

using namespace drape;
using namespace drape::ipc;
using Vector = Eigen::Vector3d;
using Catch::Contains;

namespace {

constexpr double dhat = NearSurface::dhat;

/// A flat sheet of 10 cm with 5 × 5 vertices, 12 the one in its middle.
TriangleMesh sheet() {
  TriangleMesh mesh = grid({0.1, 0.1}, 5, 5, Diagonals::one_way);
  mesh.vertices.rowwise() -= Eigen::RowVector3d(0.05, 0.05, 0);
  return mesh;
}

/// The sheet with a wall below its middle row, which shares that row's edges.
TriangleMesh sheet_with_wall() {
  TriangleMesh mesh = sheet();
  for (int k = 0; k < 5; ++k) append(mesh, {{-0.05 + 0.025 * k, 0, -0.05}}, {});
  for (int k = 0; k < 4; ++k) append(mesh, {}, {{10 + k, 11 + k, 25 + k}, {11 + k, 26 + k, 25 + k}});
  return mesh;
}

/// Both sides of the sheet's middle are tips of cones that share it.
TriangleMesh cones() {
  TriangleMesh mesh = mesh_of({{0, 0, 0}}, {});
  for (const double side : {-1.0, 1.0}) {
    const int first = static_cast<int>(mesh.vertices.rows());
    for (int k = 0; k < 6; ++k)
      append(mesh, {{0.05 * std::cos(k * M_PI / 3), 0.05 * std::sin(k * M_PI / 3), 0.04 * side}},
             {{0, first + k, first + (k + 1) % 6}});
  }
  return mesh;
}

/// Triangles at random, some of which share vertices or edges.
TriangleMesh tangle(unsigned seed) {
  RandomNumbers random(seed);
  const auto which = [&] { return static_cast<int>(random(0, 9)); };
  TriangleMesh mesh;
  for (int v = 0; v < 9; ++v) append(mesh, {random.vector(0.02)}, {});
  for (int t = 0; t < 14; ++t) append(mesh, {}, {{which(), which(), which()}});
  return repair_mesh({mesh}).frames[0];
}

}  // namespace

TEST_CASE("ipc: an obstacle's remark is that of its repair; a strict one is refused by every fault") {
  const Scratch folder;
  TriangleMesh mesh = sheet();
  append(mesh, {{9, 9, 9}, {8, 8, 8}, {7, 7, 7}}, {{0, 6, 1}, {1, 0, 6}, {2, 2, 3}, {0, 1, 2}});
  append(mesh, {{0, 0, 0.1}, {0.01, 0, 0.1}}, {{12, 28, 29}, {4, 3, 8}});
  Ipc::Parameters p;
  p.obstacles.resize(1);
  p.obstacles[0].name = "scan";
  p.obstacles[0].mesh = (folder / "scan.obj").string();
  write_mesh(p.obstacles[0].mesh, mesh);
  const RepairedMesh repaired = repair_mesh({mesh});
  CHECK(repaired.frames[0].vertices.rows() == 27);
  CHECK(Ipc(p).input_remarks() == std::vector<std::string>{"obstacle scan: " + repaired.remark});
  p.obstacles[0].strict = true;
  try {
    const Ipc refused(p);
    FAIL("a strict obstacle was repaired");
  } catch (const RefusedParameters& refused) {
    CHECK(refused.faults.size() == check_mesh(mesh).size());
    CHECK(refused.faults.size() >= 4);
    for (const ParameterFault& fault : refused.faults) {
      CHECK(fault.path == "obstacles.0");
      CHECK_THAT(fault.message, Contains("obstacle \"scan\": " + p.obstacles[0].mesh + ": "));
    }
  }
}

TEST_CASE("ipc: a mesh without faults stays as it is, one without any area is refused") {
  const TriangleMesh mesh = sheet();
  const RepairedMesh repaired = repair_mesh({mesh});
  CHECK(repaired.frames[0].vertices == mesh.vertices);
  CHECK(repaired.frames[0].triangles == mesh.triangles);
  CHECK(repaired.remark == "");
  CHECK_THROWS_WITH(repair_mesh({mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 1}})}),
                    Contains("no triangle has an area"));
}

TEST_CASE("ipc: an obstacle has no use for texture coordinates, nor for faces of one or two corners") {
  const Scratch folder;
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", off = "OFF\n4 4 0\n" + points,
                    obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt nan 0\nvt 0 inf\n",
                    ply =
                        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                        "y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\n";
  const std::string head = "end_header\n" + points, uv = "property list uchar float texcoord\n" + head;
  const auto repair = [&](const std::string& name, const std::string& text, bool strict) {
    folder.write(name, text);
    ObstacleParameters p;
    p.mesh = (folder / name).string();
    p.strict = strict;
    const ObstacleMeshes meshes = ObstacleMeshes::of(p, 0);
    CHECK(meshes.frames.at(0)->mesh.triangles.rows() == 2);
    return meshes.repair;
  };
  CHECK(repair("a.obj", obj + "f 1/1 2/2 3/1\nf 1/1 3/1 4/1\n", true) == "");
  CHECK(repair("c.obj", obj + "vt\nvt left\nvt 1 2 3 4\nf 1/9 2/-9 3/x/y\nf\nf 1/ 3/0 4/1/1/1\n", true) ==
        "");
  CHECK(repair("a.ply", replaced(ply, "face 4", "face 2") + uv + "3 0 1 2 6 0 nan 0 0 0 0\n3 0 2 3 0\n",
               true) == "");
  for (const auto& [name, text] : {std::pair("b.obj", obj + "f 1/1 2/1\nf 1 2 3\nf 4\nf 1 3 4\n"),
                                   {"b.off", off + "2 0 1\n3 0 1 2\n1 3\n3 0 2 3\n"},
                                   {"b.ply", ply + head + "2 0 1\n3 0 1 2\n1 3\n3 0 2 3\n"}}) {
    CAPTURE(name);
    CHECK(repair(name, text, false) == "obstacle mesh 0: dropped 2 triangles without area");
    CHECK_THROWS_WITH(repair(name, text, true),
                      Contains("2 triangles repeat a vertex: 0 (0, 1, 1), 2 (3, 3, 3)"));
  }
}

TEST_CASE("ipc: the frames of an animation are repaired together") {
  TriangleMesh first = sheet(), second = sheet();
  second.vertices.col(2).array() += 0.1;
  for (TriangleMesh* mesh : {&first, &second}) {
    const Vector middle = 0.5 * (mesh->vertices.row(12) + mesh->vertices.row(13));
    append(*mesh, {{9, 9, 9}, middle}, {{0, 6, 1}, {12, 13, 26}});
  }
  const RepairedMesh repaired = repair_mesh({first, second});
  REQUIRE(repaired.frames.size() == 2);
  CHECK(repaired.frames[0].triangles == repaired.frames[1].triangles);
  CHECK(repaired.frames[0].vertices == sheet().vertices);
  CHECK_THAT(repaired.remark, Contains(" and 1 triangle without area"));
  second.vertices.row(26) += Eigen::RowVector3d(0.01, 0.01, 0);
  CHECK_THROWS_WITH(
      repair_mesh({first, second}),
      Contains("triangle 33 (counted from 0) has no area in 1 of 2 frames; give it one in all of them"));

  const Scratch folder;
  write_mesh(folder / "a.obj", first);
  write_mesh(folder / "b.obj", sheet());
  folder.write("c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  folder.write("d.obj", "v 0 0 0\nv 0.3 0.4 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const auto refused = [&](const char* one, const char* other, const std::string& why) {
    ObstacleParameters p;
    p.animation = {(folder / one).string(), (folder / other).string()};
    CHECK_THROWS_WITH(ObstacleMeshes::of(p, 0), Contains(why));
  };
  refused("a.obj", "b.obj", "must have the same triangles");
  refused("c.obj", "d.obj", "into triangles before they move");
}

TEST_CASE("ipc: a flat sheet acts as its plane where a wall joins it from below") {
  TriangleMesh mesh = sheet_with_wall();
  mesh.vertices *= 10;  // so that its triangles are large against d̂
  REQUIRE_THAT(repair_mesh({mesh}).remark, Contains("kept 4 edges with more than two triangles"));
  const NearSurface near(mesh);
  RandomNumbers random(3);
  for (int i = 0; i < 400; ++i) {
    const Vector p(random(-0.6, 0.6), i % 3 == 0 ? 0 : random(-0.015, 0.015), random(1e-6, 1) * dhat);
    const Vector foot(std::clamp(p.x(), -0.5, 0.5), p.y(), 0);
    CAPTURE(p.transpose());
    CHECK(near.value(p) == Approx(barrier((p - foot).norm() / dhat).value).epsilon(1e-9).margin(1e-13));
  }
  // Between the wall and the sheet both act, less what they share.
  for (int i = 0; i < 100; ++i) {
    const Vector p(random(-0.3, 0.3), random(0.3, 0.75) * dhat, -random(1e-6, 1) * dhat);
    const double expected =
        barrier(p.y() / dhat).value + barrier(-p.z() / dhat).value - barrier(p.tail<2>().norm() / dhat).value;
    CHECK(near.value(p) == Approx(expected).epsilon(1e-9).margin(1e-13));
  }
}

TEST_CASE("ipc: a vertex of triangles that share no edge counts once, as do vertices at one place") {
  const Vector above(0, 0, 0.5 * dhat);
  const TriangleMesh bow_tie =
      mesh_of({{0, 0, 0}, {1, -0.5, 0}, {1, 0.5, 0}, {-1, 0.5, 0}, {-1, -0.5, 0}}, {{0, 1, 2}, {0, 3, 4}});
  CHECK(NearSurface(bow_tie).value(above) == Approx(barrier(0.5).value));

  const TriangleMesh whole = sheet();
  TriangleMesh apart = whole;
  apart.vertices = whole.vertices(whole.triangles.reshaped<Eigen::RowMajor>(), Eigen::all);
  for (int i = 0; i < apart.triangles.size(); ++i) apart.triangles(i / 3, i % 3) = i;
  const RepairedMesh repaired = repair_mesh({apart});
  CHECK(repaired.remark == "joined " + std::to_string(apart.vertices.rows() - whole.vertices.rows()) +
                               " vertices at the places of others");
  REQUIRE(repaired.frames[0].vertices.rows() == whole.vertices.rows());
  CHECK(NearSurface(repaired.frames[0]).value(above) == Approx(barrier(0.5).value));

  TriangleMesh parts = whole;  // a second one that touches the first at a vertex
  append(parts, {whole.vertices.row(0), {-1, 0, 0}, {-1, -1, 0}}, {{25, 26, 27}});
  const Scratch folder;
  ObstacleParameters p;
  p.mesh = (folder / "parts.ply").string();
  write_mesh(p.mesh, parts);
  CHECK_THAT(ObstacleMeshes::of(p, 0).repair, Contains("joined 1 vertex at the place of another"));
  p.strict = true;
  CHECK_THROWS_WITH(ObstacleMeshes::of(p, 0),
                    Contains("\"strict\" refuses what would be repaired: joined 1"));
}

TEST_CASE("ipc: the nearest feature of any triangles counts at least once, and the barrier has no hole") {
  std::vector<TriangleMesh> meshes = {sheet_with_wall(), cones()};
  for (unsigned seed = 1; seed < 30; ++seed) meshes.push_back(tangle(seed));
  RandomNumbers random(7);
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    const NearSurface near(meshes[k]);
    for (int i = 0; i < 200; ++i) {
      const auto t = meshes[k].triangles.row(i % meshes[k].triangles.rows());
      const double a = i % 2 ? random(0, 1) : 0, b = i % 3 ? (1 - a) * random(0, 1) : 0;
      const Vector foot = a * meshes[k].vertices.row(t[0]) + b * meshes[k].vertices.row(t[1]) +
                          (1 - a - b) * meshes[k].vertices.row(t[2]);
      const Vector p = foot + 0.5 * std::pow(10, -3 * random(0, 1)) * dhat * random.vector(1);
      const std::vector<NearestFeature> features = near.features(p);
      if (features.empty()) continue;
      const auto nearest = std::ranges::min(features, {}, &NearestFeature::distance);
      CAPTURE(k, i, p.transpose(), nearest.distance);
      CHECK(nearest.coefficient >= 1 - 1e-9);
      CHECK(near.value(p) >= 0);
    }
  }
}
